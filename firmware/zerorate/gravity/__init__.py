"""Learning against gravity: counters of signs."""
