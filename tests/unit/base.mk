UNIT_TESTS += test_base
test_base_SOURCES = tests/unit/test_base.c tests/unit/test.h tests/random.h
test_base_LDADD = $(unit_ldadd)

UNIT_TESTS += test_worker_processes
test_worker_processes_SOURCES = tests/unit/test_worker_processes.c tests/unit/test.h
test_worker_processes_LDADD = $(unit_ldadd)

UNIT_TESTS += test_hessenberg_form
test_hessenberg_form_SOURCES = tests/unit/test_hessenberg_form.c tests/unit/test.h tests/random.h
test_hessenberg_form_LDADD = $(unit_ldadd)

UNIT_TESTS += test_transaction
test_transaction_SOURCES = tests/unit/test_transaction.c tests/unit/test.h
test_transaction_LDADD = $(unit_ldadd)

UNIT_TESTS += test_surface_sides
test_surface_sides_SOURCES = tests/unit/test_surface_sides.c tests/unit/test.h
test_surface_sides_LDADD = $(unit_ldadd)

UNIT_TESTS += test_multinomial
test_multinomial_SOURCES = tests/unit/test_multinomial.c tests/random.h tests/unit/test.h
test_multinomial_LDADD = $(unit_ldadd) $(FLINT_LIBS) $(GMP_LIBS)
UNIT_TESTS += test_algebra
test_algebra_SOURCES = tests/unit/test_algebra.c tests/random.h tests/unit/test.h
test_algebra_LDADD = $(unit_ldadd)
