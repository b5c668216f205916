"""report.json and the lines for a terminal."""
