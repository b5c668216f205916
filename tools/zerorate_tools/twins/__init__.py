"""From kernels to their viper twins: what is written out, folded and kept in a local there."""
