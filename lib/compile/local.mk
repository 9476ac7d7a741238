libcore_la_SOURCES += \
  lib/compile/rounding.c \
	lib/compile/interpret.c \
	lib/compile/jacobian.c lib/compile/jacobian.h \
	lib/compile/simd_batch.c lib/compile/simd_batch.h \
	lib/compile/lower.c lib/compile/lower.h lib/compile/lower_impl.h \
	lib/compile/lowered.c \
	lib/compile/native.c lib/compile/native.h lib/compile/native_impl.h \
	lib/compile/native_registers.c \
	lib/compile/native_steps.c \
	lib/compile/opcodes.def \
	lib/compile/program.c lib/compile/program.h \
	lib/compile/program_impl.h \
	lib/compile/residual.c lib/compile/residual.h \
	lib/compile/independent_blocks.c lib/compile/schedule.c \
	lib/compile/stage.c \
	lib/compile/tangents.c lib/compile/tangents.h \
	lib/compile/workspace.c \
	lib/compile/x86.c lib/compile/x86.h
