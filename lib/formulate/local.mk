libcore_la_SOURCES += \
	lib/formulate/alike.c lib/formulate/alike.h \
	lib/formulate/accelerations.c lib/formulate/accelerations.h \
	lib/formulate/along_trees.c lib/formulate/along_trees.h \
	lib/formulate/groups.c lib/formulate/groups.h \
	lib/formulate/resistance.c lib/formulate/resistance.h \
	lib/formulate/euler_parameters.c \
	lib/formulate/expanded_shapes.c lib/formulate/partial.c \
	lib/formulate/shapes.c lib/formulate/shapes.h \
	lib/formulate/stations.c lib/formulate/stations.h \
	lib/formulate/common_turns.c \
	lib/formulate/composite.c lib/formulate/composite_mass.c lib/formulate/composite_mass.h \
	lib/formulate/constraints.c \
	lib/formulate/law_ends.c \
	lib/formulate/literals.c lib/formulate/literals.h \
	lib/formulate/counting.c \
	lib/formulate/critical.c \
	lib/formulate/coordinate.c \
	lib/formulate/derivation.c lib/formulate/derivation.h lib/formulate/derivation_impl.h \
	lib/formulate/dynamics.c \
	lib/formulate/edges.c \
	lib/formulate/edges.h \
	lib/formulate/efforts.c \
	lib/formulate/embedded.c \
	lib/formulate/energy.c \
	lib/formulate/frames.c \
	lib/formulate/framesum.c \
	lib/formulate/ideal.c lib/formulate/ideal_share.c \
	lib/formulate/kinks.c lib/formulate/recursive.c \
	lib/formulate/network.c lib/formulate/network_build.c \
	lib/formulate/network_node_rows.c lib/formulate/network_nodes.c lib/formulate/network_order.c \
	lib/formulate/network_rows.c lib/formulate/network_steps.c \
	lib/formulate/network_tree.c \
	lib/formulate/reactions.c \
	lib/formulate/rates.c lib/formulate/reading.c \
	lib/formulate/resolve.c lib/formulate/sample.c lib/formulate/scalar_edges.c \
	lib/formulate/expanded.c \
	lib/formulate/smooth.c \
	lib/formulate/state_space.c lib/formulate/state_space.h \
	lib/formulate/linear_network.c lib/formulate/linear_network.h \
	lib/formulate/ratio.c lib/formulate/ratio.h lib/formulate/response.c lib/formulate/response.h \
	lib/formulate/surfaces.h \
	lib/formulate/switches.c \
	lib/formulate/multi_turn.c lib/formulate/multi_turn_build.c \
	lib/formulate/system.c lib/formulate/system_build.c lib/formulate/system.h lib/formulate/system_impl.h \
	lib/formulate/composite.h lib/formulate/constraints.h lib/formulate/coordinate.h \
	lib/formulate/dynamics.h lib/formulate/efforts.h lib/formulate/embedded.h \
	lib/formulate/framesum.h lib/formulate/ideal.h lib/formulate/kinematics.h lib/formulate/loads.h \
	lib/formulate/network.h lib/formulate/origin.h lib/formulate/reactions.h lib/formulate/resolve.h \
	lib/formulate/sample.h lib/formulate/shown.h lib/formulate/smooth.h lib/formulate/vector.h \
	lib/formulate/redundancy.c \
	lib/formulate/variables.c \
	lib/formulate/vector.c \
	lib/formulate/tree_search.c lib/formulate/tree_search.h
