libcore_la_SOURCES += \
	lib/base/clock.h lib/base/code_memory.c lib/base/code_memory.h \
	lib/base/decimal.c lib/base/decimal.h lib/base/diag.c lib/base/diag.h lib/base/four.h lib/base/exact_memory.c lib/base/exact_memory.h lib/base/status.def \
	lib/base/faults.c lib/base/flint_functions.def lib/base/flint_library.c lib/base/flint_library.h \
	lib/base/memory.c lib/base/memory.h lib/base/memory_impl.h \
	lib/base/names.c lib/base/names.h lib/base/random.h \
	lib/base/text.c lib/base/text.h \
	lib/base/threads.c lib/base/threads.h \
	lib/base/transaction.c lib/base/transaction.h \
	lib/base/worker_processes.c lib/base/worker_processes.h \
	lib/base/call_monitor.h
