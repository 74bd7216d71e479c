"""What everything stands on: checks of arguments, fingerprints, frozen mappings, progress bars."""
