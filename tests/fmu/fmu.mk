# A simulator of our own for Functional Mock-up Units, which shares nothing with what it tests
check_PROGRAMS += fmu_master
fmu_master_SOURCES = tests/fmu/master.c tests/fmu/importer.c tests/fmu/importer.h
fmu_master_LDADD = $(ZIP_LIBS) $(EXPAT_LIBS) -ldl -lm
EXTRA_DIST += tests/fmu/description_rules.py tests/fmu/public_validators tests/fmu/quick_cc \
	tests/fmu/random_network.py

# validators of others, where they are installed
.PHONY: check-fmu
check-fmu: all
	$(AM_V_at)COTREE='$(abs_builddir)/cotree' TOP_SRCDIR='$(abs_srcdir)' $(srcdir)/tests/fmu/public_validators \
	tests/fmu/random_network.py
