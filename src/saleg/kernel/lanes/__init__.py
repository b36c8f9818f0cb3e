"""Many engines side by side, W at once, each with its own step, events and modes."""
