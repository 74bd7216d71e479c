"""Files: strict TOML, arrays without pickles, and files that are complete or not there."""
