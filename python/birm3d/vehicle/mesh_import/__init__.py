"""Vehicles whose skin is a mesh of the user: readers, checks, and the vehicle made of it."""
