# sessions to replay, developers tools

# the paper's cases
EXTRA_DIST += \
	scripts/paper/1_slider_crank_one_tree.ct \
	scripts/paper/1_slider_crank_two_trees.ct \
	scripts/paper/2_serial_counts.ct \
	scripts/paper/2_serial_indirect.ct \
	scripts/paper/2_serial_joint.ct \
	scripts/paper/2_serial_states.ct \
	scripts/paper/3_motor_arm_forward.ct \
	scripts/paper/3_motor_arm_inverse.ct \
	scripts/paper/4_spatial_slider_crank_a.ct \
	scripts/paper/4_spatial_slider_crank_c.ct \
	scripts/paper/5_microphone_cotree.ct \
	scripts/paper/5_microphone_pull_in.ct \
	scripts/paper/5_microphone_tree.ct \
	scripts/paper/6_parallel_forward.ct \
	scripts/paper/6_parallel_inverse.ct \
	scripts/paper/7_cantilever.ct \
	scripts/paper/7_spin_up.ct

# mechanisms with published reference solutions
EXTRA_DIST += \
	scripts/reference/beam_closed_forms.ct \
	scripts/reference/ref_A01_pendulum_2000s.ct \
	scripts/reference/ref_A01_pendulum_absolute.ct \
	scripts/reference/ref_A01_pendulum_joint.ct \
	scripts/reference/ref_A02_four_bar_absolute.ct \
	scripts/reference/ref_A02_four_bar_joint.ct \
	scripts/reference/ref_A03_andrews.ct \
	scripts/reference/ref_A03_andrews_beta062.ct \
	scripts/reference/ref_free_body.ct \
	scripts/reference/ref_heavy_top.ct \
	scripts/reference/ref_spatial_beam.ct \
	scripts/reference/ref_spin_up_beam.ct

# sessions to read and to type
EXTRA_DIST += scripts/tours/bouncing-ball.ct scripts/tours/first-hour.ct \
	scripts/tours/converter.ct scripts/tours/hydraulic-lift.ct \
	scripts/tours/robot-torques.ct scripts/tours/things-that-rub.ct \
	scripts/tours/things-that-stop.ct scripts/tours/things-that-touch.ct \
	scripts/tours/wheels.ct \
	scripts/tours/what-if.ct

# machines with motors, coils and controllers, and the motions that they are held to
EXTRA_DIST += \
	scripts/machines/bent-crank.ct \
	scripts/machines/bicycle.ct \
	scripts/machines/car.ct \
	scripts/machines/crane.ct \
	scripts/machines/loudspeaker.ct \
	scripts/machines/maglev.ct \
	scripts/machines/motions.py \
	scripts/machines/platform.ct \
	scripts/machines/platform.py \
	scripts/machines/slider-crank.ct

# definitions of subsystems, for `source` and `use`
EXTRA_DIST += \
	scripts/library/amplifier.ct \
	scripts/library/dc_drive.ct \
	scripts/library/gearbox.ct \
	scripts/library/leg.ct \
	scripts/library/nmos.ct \
	scripts/library/npn.ct \
	scripts/library/quarter_car.ct
