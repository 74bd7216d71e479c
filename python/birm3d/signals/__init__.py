"""Measured and computed histories: channels, filters, comparison with tests, readers of test data."""
