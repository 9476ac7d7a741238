# unit tests of lib/component and lib/model
UNIT_TESTS += test_component
test_component_SOURCES = tests/unit/test_component.c tests/unit/test_model.h tests/unit/test.h
test_component_LDADD = $(unit_ldadd)

UNIT_TESTS += test_model
test_model_SOURCES = tests/unit/test_model.c tests/unit/test_model.h tests/unit/test.h
test_model_LDADD = $(unit_ldadd)

UNIT_TESTS += test_model_wrong
test_model_wrong_SOURCES = tests/unit/test_model_wrong.c tests/unit/test_model.h tests/unit/test.h
test_model_wrong_LDADD = $(unit_ldadd)

UNIT_TESTS += test_model_history
test_model_history_SOURCES = tests/unit/test_model_history.c tests/unit/test_model.h \
	tests/unit/test.h
test_model_history_LDADD = $(unit_ldadd)

UNIT_TESTS += test_units_rows
test_units_rows_SOURCES = tests/unit/test_units_rows.c tests/unit/test_model.h tests/unit/test.h
test_units_rows_LDADD = $(unit_ldadd)
