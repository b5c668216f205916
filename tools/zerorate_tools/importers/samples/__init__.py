"""From rows of any sensors at any times to samples in order of time, in integers."""
