# components between terminals, each against a closed form
UNIT_TESTS += test_parts
test_parts_SOURCES = tests/unit/test_parts.c tests/unit/test_model.h tests/unit/session_kit.h tests/unit/test.h
test_parts_LDADD = $(unit_ldadd)
UNIT_TESTS += test_transducers
test_transducers_SOURCES = tests/unit/test_transducers.c tests/unit/test_model.h tests/unit/session_kit.h tests/unit/test.h
test_transducers_LDADD = $(unit_ldadd)
UNIT_TESTS += test_control
test_control_SOURCES = tests/unit/test_control.c tests/unit/test_model.h tests/unit/session_kit.h tests/unit/test.h
test_control_LDADD = $(unit_ldadd)
