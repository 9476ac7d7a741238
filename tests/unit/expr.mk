# unit tests of lib/expr
UNIT_TESTS += test_expr_build test_expr_code test_expr_fold test_expr_laws test_expr_print \
	test_expr_read test_expr_share test_expr_sympy test_expr_units
test_expr_build_SOURCES = tests/unit/test_expr_build.c tests/unit/test_expr.h tests/unit/test.h
test_expr_build_LDADD = $(unit_ldadd)
test_expr_code_SOURCES = tests/unit/test_expr_code.c tests/unit/test_expr.h tests/unit/test.h
test_expr_code_LDADD = $(unit_ldadd)
test_expr_fold_SOURCES = tests/unit/test_expr_fold.c tests/unit/test_expr.h tests/unit/test.h
test_expr_fold_LDADD = $(unit_ldadd)
test_expr_laws_SOURCES = tests/unit/test_expr_laws.c tests/unit/test_expr.h tests/unit/test.h
test_expr_laws_LDADD = $(unit_ldadd)
test_expr_print_SOURCES = tests/unit/test_expr_print.c tests/unit/test_expr.h tests/unit/test.h
test_expr_print_LDADD = $(unit_ldadd)
test_expr_read_SOURCES = tests/unit/test_expr_read.c tests/unit/test_expr.h \
	tests/unit/test_model.h tests/unit/test.h
test_expr_read_LDADD = $(unit_ldadd)
test_expr_share_SOURCES = tests/unit/test_expr_share.c tests/unit/test_expr.h tests/unit/test.h
test_expr_share_LDADD = $(unit_ldadd)
test_expr_sympy_SOURCES = tests/unit/test_expr_sympy.c tests/unit/test_expr.h tests/unit/test.h
test_expr_sympy_LDADD = $(unit_ldadd)
test_expr_units_SOURCES = tests/unit/test_expr_units.c tests/unit/test.h
test_expr_units_LDADD = $(unit_ldadd)
EXTRA_DIST += tests/unit/check_sympy.py
