libcore_la_SOURCES += lib/expr/expr.h lib/expr/ops.def lib/expr/units.h
