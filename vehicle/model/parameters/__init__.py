"""Parameter objects: frozen, with units, validated; read from and written to TOML."""
