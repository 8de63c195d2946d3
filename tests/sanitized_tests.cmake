# Tests with the label "sanitize", which `./dev sanitize --quick` runs: those that add most lines per second to the lines that
# the others execute, as `./dev coverage --choose` lists them, up to nine tenths of the lines that all tests execute, without
# those that take long under sanitizers for few lines. A sanitizer finds errors only in lines that run. Tests of hostile input
# are there whatever they cost; those that limit memory cannot run with sanitizers.
set(RICOCHET_SANITIZE_TESTS
  unit.base.archive unit.base.blas_kernels unit.base.child_process unit.base.child_processes
  unit.base.dense_decompositions unit.base.expression unit.base.json unit.base.number_lines unit.base.parallel
  unit.base.text unit.case.malformed_case
  unit.case.override unit.case.quantity unit.case.read_case unit.case.read_parts unit.case.read_time
  unit.contact.curved_contact unit.contact.rotating_normal unit.contact.sticking_normal unit.fclib.fclib_file
  unit.fclib.malformed_fclib unit.fem.material_law unit.fem.mesh_measures unit.fem.packed_law unit.fem.relaxation
  unit.io.checkpoint unit.io.contact_export unit.io.frame_file_killed unit.io.history_file unit.io.line_checksums
  unit.io.summary unit.linear_algebra.dense_kernels unit.linear_algebra.gmres unit.linear_algebra.sparse_cholesky
  unit.linear_algebra.supernodal_factor unit.mass.mass unit.mesh.derived_groups unit.mesh.gmsh_program
  unit.mesh.malformed_mesh unit.mesh.merge_parts unit.mesh.overlaps unit.mesh.place_mesh unit.mesh.read_mesh
  unit.mesh.reversed_cells unit.model.material_digits unit.model.model_warnings unit.model.parts
  unit.report.history_part unit.report.packed_array unit.report.surface unit.report.volume unit.rigid.free_motion
  unit.rigid.obstacle unit.run.expectations unit.run.method_watch unit.run.newton_watch unit.run.quantity_value
  unit.scheme.dense_complementarity unit.scheme.registry unit.scheme.response.restoring_impulses
  unit.scheme.step_equations unit.simulation.body_surface unit.simulation.body_watch unit.simulation.ranks
  unit.simulation.restitution unit.simulation.self_overlap unit.simulation.sliding_watch unit.solver.choose_method
  unit.solver.contact.contact_point unit.solver.contact.contact_solver_data unit.solver.contact.dependent_conditions
  unit.solver.contact.friction_robustness unit.solver.contact.twin_points unit.solver.contact_candidates
  unit.solver.delassus_columns unit.solver.moved_product unit.solver.reaction_path unit.solver.contact_basis
  unit.study.benchmark.manifest unit.study.benchmark.methods unit.study.benchmark.scorecard
  unit.study.history_errors unit.study.order_columns unit.study.plan unit.study.result_columns
  unit.study.run_folders unit.study.run_state unit.study.table
  verification.acceleration verification.adaptive_onset verification.axisymmetry.contact
  verification.axisymmetry.elements verification.contact.body_pairs verification.elements.branches
  verification.elements.stress verification.finite_critical_step verification.finite_loads
  verification.finite_midpoint verification.finite_rubber verification.inverted_cells verification.refactorize
  verification.session verification.session_steering verification.static_friction verification.static_overlap
  verification.stress_raisers verification.support_probe
  end_to_end.advice end_to_end.benchmark_command end_to_end.damaged_results end_to_end.obstacle_files
  end_to_end.parts end_to_end.placement end_to_end.self_penetration end_to_end.semantic_errors)
