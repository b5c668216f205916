"""Text that is sent to boards and run there; never imported on the host."""
