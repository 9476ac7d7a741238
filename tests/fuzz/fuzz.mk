# random input; built and run by `make fuzz` alone
