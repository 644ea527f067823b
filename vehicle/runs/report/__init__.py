"""Report of finished runs: one self-contained HTML file."""
