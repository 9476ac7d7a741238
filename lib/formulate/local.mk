libcore_la_SOURCES += \
	lib/formulate/system/constraints.h lib/formulate/system/dynamics.h \
	lib/formulate/system/kinematics.h lib/formulate/system/kinks.c lib/formulate/system/network.h \
	lib/formulate/system/origin.h lib/formulate/system/rates.c lib/formulate/system/rates.h \
	lib/formulate/system/resolve.c lib/formulate/system/resolve.h lib/formulate/system/sample.c \
	lib/formulate/system/sample.h lib/formulate/system/shown.h lib/formulate/system/smooth.c \
	lib/formulate/system/smooth.h lib/formulate/system/surfaces.h lib/formulate/system/system.c \
	lib/formulate/system/system.h lib/formulate/system/system_impl.h lib/formulate/system/vector.c \
	lib/formulate/system/vector.h \
	lib/formulate/kinematics/alike.c lib/formulate/kinematics/alike.h \
	lib/formulate/kinematics/circuits.c lib/formulate/kinematics/circuits.h \
	lib/formulate/kinematics/row_patterns.c lib/formulate/kinematics/row_patterns.h \
	lib/formulate/kinematics/common_turns.c lib/formulate/kinematics/constraint_rows.c \
	lib/formulate/kinematics/constraint_rows.h lib/formulate/kinematics/coordinate.c \
	lib/formulate/kinematics/coordinate.h lib/formulate/kinematics/critical.c \
	lib/formulate/kinematics/edges.c lib/formulate/kinematics/edges.h \
	lib/formulate/kinematics/euler_parameters.c lib/formulate/kinematics/frames.c \
	lib/formulate/kinematics/frames.h lib/formulate/kinematics/framesum.c \
	lib/formulate/kinematics/framesum.h lib/formulate/kinematics/multi_turn.c \
	lib/formulate/kinematics/identity.c lib/formulate/kinematics/identity.h \
	lib/formulate/kinematics/multi_turn.h lib/formulate/kinematics/multi_turn_build.c \
	lib/formulate/kinematics/recursive.c lib/formulate/kinematics/recursive.h \
	lib/formulate/kinematics/stations.c lib/formulate/kinematics/stations.h \
	lib/formulate/network/ideal_share.c lib/formulate/network/ideal_sides.c \
	lib/formulate/network/ideal_sides.h lib/formulate/network/law_ends.c \
	lib/formulate/network/network_alike.c lib/formulate/network/network_alike.h \
	lib/formulate/network/network.c lib/formulate/network/network_build.c \
	lib/formulate/network/network_build.h lib/formulate/network/network_impl.h \
	lib/formulate/network/network_node_rows.c lib/formulate/network/network_nodes.c \
	lib/formulate/network/network_order.c lib/formulate/network/network_rows.c \
	lib/formulate/network/network_steps.c lib/formulate/network/network_steps.h \
	lib/formulate/network/network_tree.c lib/formulate/network/scalar_edges.c \
	lib/formulate/network/scalar_edges.h \
	lib/formulate/dynamics/composite.c lib/formulate/dynamics/composite.h \
	lib/formulate/dynamics/composite_entries.c \
	lib/formulate/dynamics/composite_mass.c lib/formulate/dynamics/composite_mass.h \
	lib/formulate/dynamics/cutset_equations.c lib/formulate/dynamics/cutset_equations.h \
	lib/formulate/dynamics/efforts.c lib/formulate/dynamics/efforts.h lib/formulate/dynamics/energy.c \
	lib/formulate/dynamics/laws.c lib/formulate/dynamics/laws.h \
	lib/formulate/dynamics/loads.c lib/formulate/dynamics/loads.h lib/formulate/dynamics/reactions.c \
	lib/formulate/dynamics/reactions.h lib/formulate/dynamics/redundancy.c \
	lib/formulate/dynamics/sections.c lib/formulate/dynamics/sections.h \
	lib/formulate/dynamics/shapes.c lib/formulate/dynamics/shapes.h \
	lib/formulate/written/counting.c lib/formulate/written/derivation.c \
	lib/formulate/written/derivation.h lib/formulate/written/derivation_impl.h \
	lib/formulate/written/embedded.c lib/formulate/written/embedded.h \
	lib/formulate/written/expanded.c lib/formulate/written/expanded.h \
	lib/formulate/written/expanded_shapes.c lib/formulate/written/partial.c \
	lib/formulate/written/reading.c lib/formulate/written/reading.h \
	lib/formulate/whole/continuity.c lib/formulate/whole/continuity.h \
	lib/formulate/whole/ideal.c lib/formulate/whole/ideal.h lib/formulate/whole/literals.c \
	lib/formulate/whole/literals.h lib/formulate/whole/stays.c lib/formulate/whole/stays.h \
	lib/formulate/whole/switches.c lib/formulate/whole/system_build.c \
	lib/formulate/whole/system_end.c lib/formulate/whole/tree_search.c \
	lib/formulate/whole/tree_search.h lib/formulate/whole/variables.c \
	lib/formulate/solved/accelerations.c lib/formulate/solved/accelerations.h \
	lib/formulate/solved/along_trees.c lib/formulate/solved/along_trees.h \
	lib/formulate/solved/constrained.c lib/formulate/solved/constrained.h \
	lib/formulate/solved/groups.c lib/formulate/solved/groups.h lib/formulate/solved/linear_network.c \
	lib/formulate/solved/linear_network.h lib/formulate/solved/prescribed.c lib/formulate/solved/prescribed.h \
	lib/formulate/solved/price.h lib/formulate/solved/substituted.c lib/formulate/solved/substituted.h \
	lib/formulate/solved/ratio.c lib/formulate/solved/ratio.h \
	lib/formulate/solved/resistance.c lib/formulate/solved/resistance.h \
	lib/formulate/solved/response.c lib/formulate/solved/response.h \
	lib/formulate/solved/state_space.c lib/formulate/solved/state_space.h
