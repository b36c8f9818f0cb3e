"""Engines side by side; a composed module has its own number of them."""

WIDTH = 8
