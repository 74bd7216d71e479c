"""Vehicles whose skin is a mesh of the user: readers, checks, and what becomes of it."""
