# random input; built under the sanitizers and run by `make fuzz` alone, which adds the names in
# FUZZERS to the programs and calls each as `NAME --seconds N --seed N FOLDER` (scripts to vary)
FUZZERS += fuzz_statement
fuzz_statement_SOURCES = tests/fuzz/fuzz_statement.c tests/fuzz/mutate.c tests/fuzz/mutate.h
fuzz_statement_LDADD = $(unit_ldadd)
FUZZERS += fuzz_model
fuzz_model_SOURCES = tests/fuzz/fuzz_model.c tests/fuzz/mutate.c tests/fuzz/mutate.h
fuzz_model_LDADD = $(unit_ldadd)
FUZZERS += fuzz_session
fuzz_session_SOURCES = tests/fuzz/fuzz_session.c tests/fuzz/mutate.c tests/fuzz/mutate.h
fuzz_session_LDADD = libcotree.la $(unit_ldadd)
FUZZERS += fuzz_import
fuzz_import_SOURCES = tests/fuzz/fuzz_import.c tests/fuzz/mutate.c tests/fuzz/mutate.h
fuzz_import_LDADD = $(unit_ldadd)
