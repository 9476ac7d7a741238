# random networks
UNIT_TESTS += test_random_networks
test_random_networks_SOURCES = tests/unit/test_random_networks.c tests/unit/scene.h tests/unit/test.h
test_random_networks_LDADD = $(unit_ldadd)
