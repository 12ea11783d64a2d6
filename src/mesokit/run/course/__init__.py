"""The course of a run: what it holds, how it is stopped, what is kept of it, its loop."""
