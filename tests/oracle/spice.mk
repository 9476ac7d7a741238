# circuits against ngspice; skipped where that isn't installed
TESTS += tests/oracle/spice/circuits_agree tests/oracle/spice/points_agree \
	tests/oracle/spice/imports_agree tests/oracle/spice/temperatures_agree
EXTRA_DIST += tests/oracle/spice
