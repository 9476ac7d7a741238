# random members of families against answers from elsewhere: a few with a fixed seed in `make
# check`, any number in `make stress`, which calls each as `NAME --seed N --seconds N`
FAMILIES += family_units
family_units_SOURCES = tests/family/family_units.c tests/family/family.h \
	tests/unit/session_kit.h tests/unit/test.h
family_units_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_euler_rates
family_euler_rates_SOURCES = tests/family/family_euler_rates.c tests/family/family.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_euler_rates_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_walks
family_walks_SOURCES = tests/family/family_walks.c tests/family/family.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_walks_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_trees
family_trees_SOURCES = tests/family/family_trees.c tests/family/family.h tests/family/trees.c \
	tests/family/trees.h tests/random.h tests/unit/form.h
family_trees_LDADD = $(unit_ldadd)

FAMILIES += family_cells
family_cells_SOURCES = tests/family/family_cells.c tests/family/family.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_cells_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_subsystems
family_subsystems_SOURCES = tests/family/family_subsystems.c tests/family/family.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_subsystems_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_legs
family_legs_SOURCES = tests/family/family_legs.c tests/family/family.h tests/family/script.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_legs_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_response
family_response_SOURCES = tests/family/family_response.c tests/family/family.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_response_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_ports
family_ports_SOURCES = tests/family/family_ports.c tests/family/family.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_ports_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_linear
family_linear_SOURCES = tests/family/family_linear.c tests/unit/session_kit.h tests/unit/test.h
family_linear_LDADD = $(unit_ldadd)

FAMILIES += family_diodes
family_diodes_SOURCES = tests/family/family_diodes.c tests/family/networks.h \
	tests/family/networks_script.h
family_diodes_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_pieces
family_pieces_SOURCES = tests/family/family_pieces.c tests/family/networks.h \
	tests/family/networks_script.h tests/family/pieces.h
family_pieces_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_sliding
family_sliding_SOURCES = tests/family/family_sliding.c
family_sliding_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_odd_laws
family_odd_laws_SOURCES = tests/family/family_odd_laws.c tests/family/family.h tests/family/script.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_odd_laws_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_pulses
family_pulses_SOURCES = tests/family/family_pulses.c tests/family/family.h tests/family/one_node.h tests/random.h \
	tests/unit/session_kit.h tests/unit/test.h
family_pulses_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_short
family_short_SOURCES = tests/family/family_short.c tests/family/family.h tests/family/one_node.h tests/family/script.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_short_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_mechanisms
family_mechanisms_SOURCES = tests/family/family_mechanisms.c tests/family/bricard.h \
	tests/family/cranks.h tests/family/mechanisms.h tests/family/one_freedom.h \
	tests/family/extrapolated.h tests/family/neville.h tests/family/script.h
family_mechanisms_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_assembly
family_assembly_SOURCES = tests/family/family_assembly.c tests/family/standing.h tests/family/scenes.h tests/family/jointed.h tests/family/family.h tests/random.h \
  tests/unit/session_kit.h tests/unit/test.h
family_assembly_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_guesses
family_guesses_SOURCES = tests/family/family_guesses.c tests/family/standing.h tests/family/scenes.h tests/family/jointed.h tests/family/family.h tests/random.h \
  tests/unit/session_kit.h tests/unit/test.h
family_guesses_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_point_masses
family_point_masses_SOURCES = tests/family/family_point_masses.c tests/family/family.h tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_point_masses_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_events
family_events_SOURCES = tests/family/family_events.c tests/family/family.h tests/family/script.h
family_events_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_moved
family_moved_SOURCES = tests/family/family_moved.c tests/family/moving.h tests/family/standing.h tests/family/scenes.h \
	tests/family/jointed.h tests/family/family.h tests/random.h
family_moved_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_stays
family_stays_SOURCES = tests/family/family_stays.c tests/family/moving.h tests/family/standing.h tests/family/scenes.h \
	tests/family/jointed.h tests/family/family.h tests/random.h
family_stays_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_sections
family_sections_SOURCES = tests/family/family_sections.c tests/family/family.h tests/family/script.h \
	tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_sections_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_sharing
family_sharing_SOURCES = tests/family/family_sharing.c tests/family/family.h tests/family/script.h
family_sharing_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_redundant
family_redundant_SOURCES = tests/family/family_redundant.c tests/family/mechanisms.h \
	tests/family/one_freedom.h tests/family/extrapolated.h tests/family/neville.h tests/family/script.h
family_redundant_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_hanging
family_hanging_SOURCES = tests/family/family_hanging.c tests/family/family.h tests/family/script.h \
	tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_hanging_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_sensitivities
family_sensitivities_SOURCES = tests/family/family_sensitivities.c tests/family/family.h tests/family/script.h
family_sensitivities_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_falls
family_falls_SOURCES = tests/family/family_falls.c tests/family/family.h tests/family/script.h
family_falls_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_edits
family_edits_SOURCES = tests/family/family_edits.c tests/family/edits.h tests/family/family.h tests/random.h \
	tests/unit/session_kit.h tests/unit/test.h
family_edits_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_reformed
family_reformed_SOURCES = tests/family/family_reformed.c tests/family/reformed.c \
	tests/family/reformed.h tests/family/edits.h tests/family/family.h tests/random.h
family_reformed_LDADD = $(unit_ldadd)

FAMILIES += family_inertial_laws
family_inertial_laws_SOURCES = tests/family/family_inertial_laws.c tests/family/family.h \
	tests/family/script.h
family_inertial_laws_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_walls
family_walls_SOURCES = tests/family/family_walls.c tests/family/family.h tests/family/script.h
family_walls_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_stress_motions
family_stress_motions_SOURCES = tests/family/family_stress_motions.c tests/family/bricard.h \
	tests/family/cranks.h tests/family/extrapolated.h tests/family/neville.h tests/family/jointed.h \
	tests/family/mechanisms.h tests/family/one_freedom.h tests/family/script.h \
	tests/family/stress.h
family_stress_motions_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_stress_runs
family_stress_runs_SOURCES = tests/family/family_stress_runs.c tests/family/mechanisms.h \
	tests/family/one_freedom.h tests/family/extrapolated.h tests/family/neville.h tests/family/script.h \
	tests/family/stress.h
family_stress_runs_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_native
family_native_SOURCES = tests/family/family_native.c tests/family/family.h tests/random.h
family_native_LDADD = $(unit_ldadd)

FAMILIES += family_derivation
family_derivation_SOURCES = tests/family/family_derivation.c tests/family/family.h \
	tests/family/shown_models.h tests/family/script.h tests/unit/session_kit.h tests/unit/test.h
family_derivation_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_printed
family_printed_SOURCES = tests/family/family_printed.c tests/family/family.h \
	tests/family/shown_models.h tests/family/script.h tests/unit/session_kit.h tests/unit/test.h
family_printed_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_beam_laws
family_beam_laws_SOURCES = tests/family/family_beam_laws.c tests/family/family.h tests/family/script.h \
	tests/family/shapes.h 	tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_beam_laws_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_flexible_arms
family_flexible_arms_SOURCES = tests/family/family_flexible_arms.c tests/family/family.h \
	tests/family/script.h tests/family/shapes.h tests/unit/session_kit.h tests/unit/test.h
family_flexible_arms_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_beam_machines
family_beam_machines_SOURCES = tests/family/family_beam_machines.c tests/family/family.h tests/family/script.h \
	tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_beam_machines_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_beams
family_beams_SOURCES = tests/family/family_beams.c tests/family/family.h tests/family/script.h \
	tests/unit/session_kit.h tests/unit/test.h
family_beams_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_couplers
family_couplers_SOURCES = tests/family/family_couplers.c tests/family/family.h \
	tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_couplers_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_far
family_far_SOURCES = tests/family/family_far.c tests/family/family.h \
	tests/family/linear_entries.c tests/family/linear_entries.h tests/unit/session_kit.h \
	tests/unit/test.h tests/random.h
family_far_LDADD = $(unit_ldadd)
FAMILIES += family_jacobians
family_jacobians_SOURCES = tests/family/family_jacobians.c tests/family/family.h \
	tests/family/jacobians.c tests/family/jacobians.h \
	tests/unit/simulate_script.h tests/unit/form.h tests/unit/test.h tests/random.h
family_jacobians_LDADD = $(unit_ldadd)

FAMILIES += family_estimates
family_estimates_SOURCES = tests/family/family_estimates.c tests/family/family.h \
	tests/family/script.h tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_estimates_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_machines
family_machines_SOURCES = tests/family/family_machines.c tests/family/machine.h \
	tests/family/machine_draw.h tests/family/machine_networks.h tests/family/machine_tableau.h \
	tests/family/machine_whole.h \
	tests/family/extrapolated.h tests/family/neville.h tests/family/family.h tests/family/script.h tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_machines_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_machine_slopes
family_machine_slopes_SOURCES = tests/family/family_machine_slopes.c tests/family/machine.h \
	tests/family/machine_draw.h tests/family/machine_networks.h \
	tests/family/machine_inputs.h tests/family/machine_slopes.h tests/family/machine_tableau.h \
	tests/family/machine_whole.h \
	tests/family/extrapolated.h tests/family/neville.h tests/family/family.h tests/family/script.h \
	tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_machine_slopes_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_machine_code
family_machine_code_SOURCES = tests/family/family_machine_code.c tests/family/machine.h \
	tests/family/machine_hybrid.h tests/family/machine_hybrid_draw.h \
	tests/family/machine_draw.h tests/family/machine_networks.h \
	tests/family/machine_inputs.h tests/family/machine_slopes.h tests/family/machine_tableau.h \
	tests/family/machine_whole.h \
	tests/family/extrapolated.h tests/family/neville.h tests/family/family.h tests/family/script.h \
	tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_machine_code_LDADD = libcotree.la $(unit_ldadd) -ldl

FAMILIES += family_machine_figures
family_machine_figures_SOURCES = tests/family/family_machine_figures.c tests/family/machine.h \
	tests/family/machine_draw.h tests/family/machine_networks.h \
	tests/family/machine_tableau.h tests/family/machine_whole.h \
	tests/family/extrapolated.h tests/family/neville.h tests/family/family.h tests/family/script.h \
	tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_machine_figures_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_machine_jumps
family_machine_jumps_SOURCES = tests/family/family_machine_jumps.c tests/family/machine.h \
	tests/family/machine_draw.h tests/family/machine_hybrid.h tests/family/machine_hybrid_draw.h \
	tests/family/machine_networks.h tests/family/machine_tableau.h tests/family/machine_whole.h \
	tests/family/extrapolated.h tests/family/neville.h tests/family/family.h tests/family/script.h \
	tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_machine_jumps_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_machine_fmu
family_machine_fmu_SOURCES = tests/family/family_machine_fmu.c tests/family/machine.h tests/family/units.h \
	tests/family/machine_draw.h tests/family/machine_hybrid.h tests/family/machine_hybrid_draw.h \
	tests/family/machine_networks.h tests/family/machine_tableau.h tests/family/machine_whole.h \
	tests/family/extrapolated.h tests/family/neville.h tests/family/family.h tests/family/script.h \
	tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_machine_fmu_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_machine_uses
family_machine_uses_SOURCES = tests/family/family_machine_uses.c tests/family/machine.h \
	tests/family/machine_draw.h tests/family/machine_hybrid.h tests/family/machine_hybrid_draw.h \
	tests/family/machine_inputs.h tests/family/machine_slopes.h \
	tests/family/machine_networks.h tests/family/machine_tableau.h tests/family/machine_whole.h \
	tests/family/extrapolated.h tests/family/neville.h tests/family/family.h tests/family/script.h \
	tests/unit/session_kit.h tests/unit/test.h tests/random.h
family_machine_uses_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_attitudes
family_attitudes_SOURCES = tests/family/family_attitudes.c tests/family/family.h \
	tests/family/script.h tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_attitudes_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_network_trees
family_network_trees_SOURCES = tests/family/family_network_trees.c tests/family/family.h \
	tests/family/script.h tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_network_trees_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_rounding
family_rounding_SOURCES = tests/family/family_rounding.c tests/family/family.h \
	tests/family/script.h tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_rounding_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_power
family_power_SOURCES = tests/family/family_power.c tests/family/family.h tests/family/script.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_power_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_complement
family_complement_SOURCES = tests/family/family_complement.c tests/family/family.h \
	tests/family/script.h tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_complement_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_edges
family_edges_SOURCES = tests/family/family_edges.c tests/family/family.h tests/family/script.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_edges_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_tanks
family_tanks_SOURCES = tests/family/family_tanks.c tests/family/family.h tests/family/script.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_tanks_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_thermostats
family_thermostats_SOURCES = tests/family/family_thermostats.c tests/family/family.h \
	tests/family/script.h tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_thermostats_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_stiff
family_stiff_SOURCES = tests/family/family_stiff.c tests/family/family.h tests/family/implicit_euler.h tests/family/neville.h \
	tests/family/script.h tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_stiff_LDADD = libcotree.la $(unit_ldadd)

FAMILIES += family_complementarity
family_complementarity_SOURCES = tests/family/family_complementarity.c tests/family/family.h \
	tests/random.h
family_complementarity_LDADD = $(unit_ldadd)

FAMILIES += family_norm_bounds
family_norm_bounds_SOURCES = tests/family/family_norm_bounds.c tests/family/family.h \
	tests/random.h
family_norm_bounds_LDADD = $(unit_ldadd)

FAMILIES += family_bushings
family_bushings_SOURCES = tests/family/family_bushings.c tests/family/family.h \
	tests/family/free_bodies.h tests/family/vectors.h tests/random.h tests/unit/session_kit.h \
	tests/unit/test.h
family_bushings_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_friction
family_friction_SOURCES = tests/family/family_friction.c tests/family/family.h tests/family/units.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_friction_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_friction_limits
family_friction_limits_SOURCES = tests/family/family_friction_limits.c tests/family/family.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_friction_limits_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_rolling
family_rolling_SOURCES = tests/family/family_rolling.c tests/family/family.h tests/unit/session_kit.h \
	tests/family/vectors.h tests/random.h
family_rolling_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_rubbing
family_rubbing_SOURCES = tests/family/family_rubbing.c tests/family/family.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_rubbing_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_contacts
family_contacts_SOURCES = tests/family/family_contacts.c tests/family/family.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_contacts_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_loads
family_loads_SOURCES = tests/family/family_loads.c tests/family/family.h tests/random.h
family_loads_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_impacts
family_impacts_SOURCES = tests/family/family_impacts.c tests/family/family.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_impacts_LDADD = libcotree.la $(unit_ldadd)
FAMILIES += family_journals
family_journals_SOURCES = tests/family/family_journals.c tests/family/family.h \
	tests/random.h tests/unit/session_kit.h tests/unit/test.h
family_journals_LDADD = libcotree.la $(unit_ldadd)
