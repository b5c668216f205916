"""The kernels as the firmware calls them: machine code where it is right, else bytecode."""
