"""Records and tables as files: text and npz, read and written in one place."""
