"""Logs as other tools write them, each of one world whose truth is known, and what import says."""
