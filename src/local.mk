# the shell
