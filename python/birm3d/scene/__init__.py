"""What is run: settings, how a scene is written to files, and what is looked at before a run."""
