# The product: the single list of files, read by CMakeLists.txt and by the check of ccs_project/.
set(CONTROL_SOURCES
    control/aim.c control/altitude.c control/approach.c control/arming.c control/around.c control/attitude.c control/battery.c control/battery_orders.c control/bounds.c control/calibration.c
    control/est/actuator.c control/est/cascade.c control/est/credit.c control/est/deadband.c control/est/dips.c control/est/effect.c control/est/innovation.c
    control/est/est_law.c control/est/estimator.c control/est/filter.c control/est/hover.c control/est/learning.c
    control/est/ahead.c control/est/let_down.c control/est/lift_off.c control/est/roughness.c control/est/terrain.c control/est/terrain_hypothesis.c control/est/terrain_keep.c control/est/terrain_ramp.c control/flight.c
    control/guard.c control/handover.c control/imu_axes.c control/imu_finding.c control/imu_mapping.c control/imu_repeat.c control/imu_sample.c
    control/in_air.c control/laws/descent.c control/laws/law_descent.c control/laws/law_est.c control/laws/law_pid.c
    control/laws/law_pidt.c control/laws/laws.c control/laws/pid.c control/laws/pidt.c control/laws/stuck_pin.c control/median.c
    control/modes.c control/outputs.c control/parameters.c control/ray_clock.c control/reach.c control/sense/accelerometer.c
    control/sense/belief.c control/sense/belief_world.c control/sense/confirmation.c control/sense/heights.c control/sense/mirrors.c
    control/sense/mounts.c control/sense/plane.c control/sense/push.c control/sense/sense.c control/sense/senses.c control/sense/stand.c
    control/sense/sway.c control/sense/tilt.c control/sense/verdict.c control/sense/witness.c control/signs.c
    control/sense/zeros.c control/situation.c control/stick.c control/stick_orders.c control/thrust.c control/where/contact.c
    control/where/flight_state.c control/where/hover_thrust.c control/where/piloting.c control/where/supervisor.c
    control/walls.c control/where/where.c)
set(DRIVERS_SOURCES
    drivers/around_line.c drivers/decimal.c drivers/flight_beams.c drivers/flight_log.c drivers/line_sum.c drivers/parameter_image.c drivers/razor.c drivers/scip_free.c drivers/scip_info.c
    drivers/scip_layout.c drivers/scip_parser.c drivers/scip_request.c drivers/telecommand.c
    drivers/telemetry.c drivers/urg.c drivers/urg_link.c)
set(BSP_SOURCES
    bsp/board.c bsp/led.c bsp/receiver.c bsp/reset.c bsp/retained.c bsp/selector.c bsp/start.c bsp/storage.c bsp/throttle.c bsp/timebase.c bsp/uart.c
    bsp/usb.c bsp/voltmeter.c bsp/watchdog.c)
set(FIRMWARE_SOURCES
    firmware/alive.c firmware/answer.c firmware/boot.c firmware/calibrator.c firmware/commands.c firmware/cpu_time.c firmware/fault.c
    firmware/flight_recorder.c firmware/geometry.c firmware/ground.c firmware/imu_exchange.c firmware/imu_gate.c firmware/imu_port.c firmware/laser_port.c firmware/listing.c firmware/main.c firmware/mirror_gate.c
    firmware/monitor.c firmware/parameter_store.c firmware/published.c firmware/pulse_stream.c firmware/servers.c firmware/surroundings.c firmware/task_control.c
    firmware/task_imu.c
    firmware/task_receive_comm.c firmware/task_receive_laser.c firmware/task_send_comm.c firmware/task_send_laser.c
    firmware/uart_port.c firmware/usb_port.c firmware/verb_battery.c firmware/verb_bench.c firmware/verb_calibrate.c firmware/verb_imu.c firmware/verb_laser.c firmware/verb_log.c firmware/verb_mirrors.c firmware/verb_perf.c firmware/verb_reference.c
    firmware/verb_save.c firmware/verb_stick.c firmware/xbee_port.c)
