# random input; built under the sanitizers and run by `make fuzz` alone, which adds the names in
# FUZZERS to the programs and calls each as `NAME --seconds N --seed N FOLDER` (scripts to vary)
