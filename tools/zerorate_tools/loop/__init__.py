"""The loop: from recordings of one device to the effects that its model lacks, and how sure they
are. `close.close` stands above; a recording goes through read, fit, motion, search, verify, report.
"""
