libcore_la_SOURCES += \
	lib/formulate/formulate_limits.h \
	lib/formulate/system/constraints.h lib/formulate/system/dynamics.h \
	lib/formulate/system/kinematics.h lib/formulate/system/nonsmooth_points.c lib/formulate/system/network.h \
	lib/formulate/system/origin.h lib/formulate/system/rates.c lib/formulate/system/rates.h \
	lib/formulate/system/resolve.c lib/formulate/system/resolve.h lib/formulate/system/sample.c \
	lib/formulate/system/sample.h lib/formulate/system/shown.h lib/formulate/system/smooth.c \
	lib/formulate/system/smooth.h lib/formulate/system/surfaces.h lib/formulate/system/system.c \
	lib/formulate/system/system.h lib/formulate/system/system_impl.h lib/formulate/system/vector.c \
	lib/formulate/system/vector.h \
	lib/formulate/kinematics/isomorphic.c lib/formulate/kinematics/isomorphic.h \
	lib/formulate/kinematics/circuits.c lib/formulate/kinematics/circuits.h \
	lib/formulate/kinematics/row_patterns.c lib/formulate/kinematics/row_patterns.h \
	lib/formulate/kinematics/common_turns.c lib/formulate/kinematics/constraint_rows.c \
	lib/formulate/kinematics/constraint_rows.h lib/formulate/kinematics/contact_rows.c lib/formulate/kinematics/contact_rows.h lib/formulate/kinematics/coordinate.c \
	lib/formulate/kinematics/coordinate.h lib/formulate/kinematics/critical.c \
	lib/formulate/kinematics/edges.c lib/formulate/kinematics/edges.h \
	lib/formulate/kinematics/euler_parameters.c lib/formulate/kinematics/frames.c \
	lib/formulate/kinematics/frames.h lib/formulate/kinematics/framesum.c \
	lib/formulate/kinematics/framesum.h lib/formulate/kinematics/multi_turn.c \
	lib/formulate/kinematics/identities_build.c \
	lib/formulate/kinematics/identity.c lib/formulate/kinematics/identity.h \
	lib/formulate/kinematics/multi_turn.h lib/formulate/kinematics/multi_turn_build.c \
	lib/formulate/kinematics/recursive.c lib/formulate/kinematics/recursive.h \
	lib/formulate/kinematics/rotation_vector.c lib/formulate/kinematics/rotation_vector.h \
	lib/formulate/kinematics/section_frames.c lib/formulate/kinematics/section_frames.h \
	lib/formulate/network/ideal_share.c lib/formulate/network/ideal_sides.c \
	lib/formulate/network/ideal_sides.h lib/formulate/network/law_ends.c \
	lib/formulate/network/network_isomorphic.c lib/formulate/network/network_isomorphic.h \
	lib/formulate/network/network.c lib/formulate/network/network_build.c \
	lib/formulate/network/network_build.h lib/formulate/network/network_impl.h \
	lib/formulate/network/network_node_rows.c lib/formulate/network/network_nodes.c \
	lib/formulate/network/network_order.c lib/formulate/network/network_rows.c \
	lib/formulate/network/network_steps.c lib/formulate/network/network_steps.h \
	lib/formulate/network/network_tree.c lib/formulate/network/scalar_edges.c \
	lib/formulate/network/scalar_edges.h lib/formulate/network/uncharged_nodes.c \
	lib/formulate/dynamics/bushings.c lib/formulate/dynamics/bushings.h \
	lib/formulate/dynamics/composite.c lib/formulate/dynamics/composite.h \
	lib/formulate/dynamics/composite_entries.c \
	lib/formulate/dynamics/composite_mass.c lib/formulate/dynamics/composite_mass.h \
	lib/formulate/dynamics/cutset_equations.c lib/formulate/dynamics/cutset_equations.h \
	lib/formulate/dynamics/edge_power.c lib/formulate/dynamics/edge_power.h \
	lib/formulate/dynamics/efforts.c lib/formulate/dynamics/efforts.h lib/formulate/dynamics/rubbing.c lib/formulate/dynamics/rubbing.h lib/formulate/dynamics/losses.c lib/formulate/dynamics/losses.h lib/formulate/dynamics/energy.c \
	lib/formulate/dynamics/laws.c lib/formulate/dynamics/laws.h \
	lib/formulate/dynamics/loads.c lib/formulate/dynamics/loads.h lib/formulate/dynamics/reactions.c \
	lib/formulate/dynamics/reactions.h lib/formulate/dynamics/redundancy.c \
	lib/formulate/dynamics/rests.c lib/formulate/dynamics/rests.h \
	lib/formulate/dynamics/sections.c lib/formulate/dynamics/sections.h \
	lib/formulate/dynamics/shapes.c lib/formulate/dynamics/shapes.h \
	lib/formulate/expanded/block_entry.c lib/formulate/expanded/block_entry.h \
	lib/formulate/expanded/counting.c lib/formulate/expanded/derivation.c \
	lib/formulate/expanded/derivation.h lib/formulate/expanded/derivation_impl.h \
	lib/formulate/expanded/embedded.c lib/formulate/expanded/embedded.h \
	lib/formulate/expanded/expanded.c lib/formulate/expanded/expanded.h \
	lib/formulate/expanded/expanded_shapes.c lib/formulate/expanded/partial.c \
	lib/formulate/expanded/equation_form.c lib/formulate/expanded/equation_form.h \
	lib/formulate/system_build/continuity.c lib/formulate/system_build/continuity.h \
	lib/formulate/system_build/ideal.c lib/formulate/system_build/ideal.h lib/formulate/system_build/lifted_constants.c \
	lib/formulate/system_build/lifted_constants.h lib/formulate/system_build/held_coordinates.c lib/formulate/system_build/held_coordinates.h \
	lib/formulate/system_build/switches.c lib/formulate/system_build/system_build.c \
	lib/formulate/system_build/system_end.c lib/formulate/system_build/tree_search.c \
	lib/formulate/system_build/tree_search.h lib/formulate/system_build/variables.c \
	lib/formulate/reduced/accelerations.c lib/formulate/reduced/accelerations.h \
	lib/formulate/reduced/along_trees.c lib/formulate/reduced/along_trees.h \
	lib/formulate/reduced/common_denominator.c lib/formulate/reduced/common_denominator.h \
	lib/formulate/reduced/constrained.c lib/formulate/reduced/constrained.h \
	lib/formulate/reduced/groups.c lib/formulate/reduced/groups.h lib/formulate/reduced/linear_network.c \
	lib/formulate/reduced/linear_network.h lib/formulate/reduced/prescribed.c lib/formulate/reduced/prescribed.h \
	lib/formulate/reduced/operation_cost.h lib/formulate/reduced/substituted.c lib/formulate/reduced/substituted.h \
	lib/formulate/reduced/ratio.c lib/formulate/reduced/ratio.h \
	lib/formulate/reduced/resistance.c lib/formulate/reduced/resistance.h \
	lib/formulate/reduced/response.c lib/formulate/reduced/response.h \
	lib/formulate/reduced/port.c lib/formulate/reduced/port.h \
	lib/formulate/reduced/state_space.c lib/formulate/reduced/state_space.h \
	lib/formulate/reduced/symbolic_solve.c lib/formulate/reduced/symbolic_solve.h
