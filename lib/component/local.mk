libcore_la_SOURCES += \
	lib/component/component.c lib/component/component.h lib/component/component_table.c \
	lib/component/component_rows.h lib/component/types.def \
	lib/component/attitude.c lib/component/beam.c lib/component/beam.h lib/component/beam_axis.c \
	lib/component/beam_graded.c lib/component/beam_graded.h lib/component/beam_inertia.c lib/component/beam_rotary.c \
	lib/component/beam_section.c lib/component/beam_shapes.c lib/component/bodies.c \
	lib/component/bushing.c lib/component/constvel.c lib/component/driver.c \
	lib/component/control.c lib/component/control.h lib/component/controlled.c \
	lib/component/electrical.c lib/component/forces.c lib/component/friction.c lib/component/equation_block.c \
	lib/component/equation_block.h lib/component/hydraulic.c \
	lib/component/joints.c lib/component/joints_round.c lib/component/pid.c \
  lib/component/contacts.c lib/component/contacts.h lib/component/stops.c lib/component/touching.c \
	lib/component/scalar.c lib/component/screw.c lib/component/shaft.c lib/component/slide.c \
	lib/component/switching.c lib/component/thermal.c lib/component/transducers.c \
	lib/component/twoports.c
