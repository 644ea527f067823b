"""Every system call of every command fails once: no results are lost, and the message is true."""
