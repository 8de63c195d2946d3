#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "ricochet/io/summary_visitor.hpp"

namespace ricochet {

void describe(SummaryVisitor& visit, ProcessReport& processes) {
  visit.type("Processes");
  visit("count", processes.count, "number of processes");
  visit("least_dofs", processes.least_dofs, "smallest number of dofs of a process, including shared ones");
  visit("most_dofs", processes.most_dofs, "largest number of dofs of a process");
  visit("messages_per_step", processes.messages_per_step, "largest number of messages that a process sends per step");
  visit("bytes_per_step", processes.bytes_per_step, "largest number of bytes that a process sends per step");
  visit("reductions_per_step", processes.reductions_per_step, "sums and maxima over all processes, per step");
}

void describe(SummaryVisitor& visit, IterationReport& iterations) {
  visit.type("Iterations");
  visit("rounds_per_step", iterations.schwarz_iterations_per_step, "iterations of contact subdomains and the body");
  visit("gradients_per_step", iterations.gradients_per_step, "iterations of conjugate gradients");
}

void describe(SummaryVisitor& visit, AdaptiveSteps& steps) {
  StepCounts& counts = steps.counts;
  visit.type("AdaptiveSteps");
  visit("tolerance", steps.tolerance, "tolerance of the case");
  visit("time", steps.time, "time that the run has reached");
  visit("shortest", counts.shortest, "shortest step");
  visit("longest", counts.longest, "longest step");
  visit("refused", counts.refused, "number of attempts whose error was too large");
  visit("unsolved", counts.unsolved, "number of attempts without a solution");
  visit("above_tolerance", counts.tolerated, "number of steps of the smallest length whose error was too large");
  visit("largest_error", Real{counts.largest_error}, "largest error of a step, relative to the tolerance");
}

namespace {

/// Instants of a scheme's results.
struct InstantsOf {
  RunSummary& run;
};

/// Visits an instant, such as "t +0.5 time_step".
void describe_instant(SummaryVisitor& visit, const char* name, double& steps, const char* text) {
  std::string instant = fmt::format("t {:+g} time_step", steps);
  visit(name, instant, text);
  if (visit.reads() && std::sscanf(instant.c_str(), "t %lf time_step", &steps) != 1)
    throw Json::Exception(fmt::format("instants: \"{}\" is not an instant", instant));
}

void describe(SummaryVisitor& visit, InstantsOf& instants) {
  visit.type("Instants");
  describe_instant(visit, "energy", instants.run.energy_instant, "of energies and momenta");
  describe_instant(visit, "force", instants.run.force_instant, "of contact forces");
}

/// Contributions to the change of the energy.
struct BudgetAtEnd {
  MethodEnergy& method;
};

void describe(SummaryVisitor& visit, BudgetAtEnd& budget) {
  const RunSummary& run = visit.run();
  const double scale = run.energy_scale();
  const auto part = [&](const char* column, double sign = 1.0) {
    return Real{scale > 0.0 ? sign * run.digest(column).last / scale : 0.0};
  };
  visit.type("BudgetAtEnd");
  visit("method", Real{budget.method.at_end}, "time discretization");
  visit.derived("friction", part("friction_work"), "friction");
  visit.derived("damping", part("damping_work"), "damping");
  visit.derived("supports", part("support_work"), "supports that move");
  visit.derived("obstacles", part("obstacle_work"), "obstacles that move");
  visit.derived("loads", part("load_work"), "loads that vary");
  const bool relaxes = std::ranges::count(run.columns, "viscous_dissipation") > 0;
  if (!visit.reads())
    visit.optional("relaxation", relaxes, part("viscous_dissipation", -1.0), "viscoelastic branches of materials");
}

}  // namespace

void describe(SummaryVisitor& visit, MethodEnergy& method) {
  visit.type("EnergyBudget");
  visit.derived("largest_energy", Real{visit.run().energy_scale()}, "unit of the other entries, `energy_scale`");
  visit("lost_by_method", Real{method.lost}, "largest deficit of energy since the start, over all steps");
  visit("created_by_method", Real{method.created}, "largest excess of energy since the start, over all steps");
  visit("at_end", BudgetAtEnd{method}, "contribution of each cause at the end; negative if it took energy away");
}

void describe(SummaryVisitor& visit, ActingReactions& acting) {
  const bool any = acting.mean_steps > 0;
  visit.type("Reactions");
  visit("acting", acting.kind,
        "effect of `reaction_weight`: \"end\", the reactions at the end of each step; \"adaptive\", a mixture of these "
        "and the mean; \"mean\", the mean alone");
  visit("least_end_weight", IfKnown{any, Real{acting.least_weight}}, "least weight of the end reactions in a mean");
  visit("largest_end_weight", IfKnown{any, Real{acting.largest_weight}}, "largest weight");
  visit("steps_of_means", acting.mean_steps, "number of these steps");
  visit("steps_without_mean", acting.end_steps, "number of steps with contact for which no mean was found");
}

void describe(SummaryVisitor& visit, VelocityCorrections& corrections) {
  const bool any = corrections.steps > 0;
  visit.type("VelocityCorrections");
  visit("steps", corrections.steps, "number of steps in which they changed more than 10⁻⁴ of the energy");
  visit("first_time", IfKnown{any, corrections.first_time}, "time of the first such step; null if there is none");
  visit("largest", Real{corrections.largest},
        "largest change of the kinetic energy by them in a step, divided by kinetic and elastic energy at its end");
  visit("time", corrections.time, "time of that step");
}

void describe(SummaryVisitor& visit, UnsettledContact& contact) {
  visit.type("UnsettledContact");
  visit("contact", contact.contact, "number of the entry of `[[contact]]`");
  visit("share_of_force", Real{contact.share},
        "largest normal force at stake, divided by the largest normal force of the contact plus the forces missing at "
        "overlaps");
  visit("steps", contact.steps, "number of steps with such a point");
  visit("first_time", contact.first_time, "time of the first such step");
  visit("time", contact.time, "time of the largest force at stake");
  visit("gap", Real{contact.gap}, "widest gap at that time; negative: an overlap");
  visit("place", contact.position, "position of its point in the undeformed body");
}

void describe(SummaryVisitor& visit, PairingDescription& facing) {
  visit.type("Facing");
  visit("multipliers_on", facing.multipliers_on, "group that carries the multipliers");
  visit("reason", facing.reason, "reason for this choice; empty if the case prescribes it");
  visit("contact_points", facing.points, "number of contact points");
  visit("covered", Real{facing.covered}, "fraction of that group's area that faces the other group");
  visit("smallest_gap", Real{facing.smallest_gap}, "smallest gap at the start");
  visit("largest_gap", Real{facing.largest_gap}, "largest gap at the start");
}

void describe(SummaryVisitor& visit, ContactDescription& contact) {
  visit.type("Contact");
  visit("group", contact.group, "facet group of the body");
  if (visit.reads()) contact.between_bodies = visit.has("against");
  visit.optional("obstacle", !contact.between_bodies, contact.opponent, "name of the obstacle");
  visit.optional("against", contact.between_bodies, contact.opponent, "between bodies: facet group of the other body");
  visit("multipliers", contact.multipliers, "multiplier space");
  visit("friction", contact.friction, "coefficient of Coulomb friction");
  visit("friction_bound", contact.friction_bound, "bound of Tresca friction");
  visit("obstacle_velocity", contact.obstacle_velocity, "velocity of the obstacle at the start; empty at rest");
  visit("obstacle_rotation_rate", contact.obstacle_rotation_rate, "rate of rotation of the obstacle");
  visit.optional("tied", contact.between_bodies, contact.tied, "between bodies: whether they are glued together");
  visit.optional("pair_of", !contact.all_pairs_group.empty(), contact.all_pairs_group,
                 "group of the entry for all pairs, if it is of one");
  visit.optional("obstacle_moves_freely", contact.obstacle_moves_freely, contact.obstacle_moves_freely,
                 "true if forces move the obstacle");
  visit.optional("facing", contact.facing, "between bodies: their initial pairing");
}

void describe(SummaryVisitor& visit, ProbeDescription& probe) {
  bool in_contact_boundary = probe.probe.contact_node >= 0;
  visit.type("Probe");
  visit("name", probe.probe.name, "name in the columns of the history");
  visit("node", probe.probe.node, "number of the node");
  visit("position", probe.position, "its position in the undeformed body");
  visit("distance", probe.probe.distance, "its distance from the point or segment of the case");
  visit("in_contact_boundary", in_contact_boundary, "whether it is a contact node");
  if (visit.reads()) probe.probe.contact_node = in_contact_boundary ? 0 : -1;
}

void describe(SummaryVisitor& visit, std::pair<std::string, std::string>& probe_sum) {
  visit.type("ProbeSum");
  visit("name", probe_sum.first, "name of the probe");
  visit("sums", probe_sum.second, "forces that it sums, in words");
}

void describe(SummaryVisitor& visit, ColumnDigest& digest) {
  visit.type("Extrema");
  visit("first", Real{digest.first}, "value of the first row");
  visit("last", Real{digest.last}, "value of the last row");
  visit("minimum", Real{digest.minimum}, "smallest value");
  visit("maximum", Real{digest.maximum}, "largest value");
  visit("total_variation", Real{digest.total_variation}, "sum of the sizes of all changes from row to row");
}

void describe(SummaryVisitor& visit, CheckResult& check) {
  visit.type("Check");
  visit("limit", check.limit, "limit of the case, relative; 0: not checked");
  visit("largest", Real{check.largest}, "largest error, relative");
}

void describe(SummaryVisitor& visit, ExpectationResult& expectation) {
  visit.type("Expectation");
  visit("name", expectation.name, "name of the case; may be empty");
  visit("quantity", expectation.quantity, "quantity as in the case, with its factor and its divisor");
  visit("published", expectation.published, "published value, in words; may be empty");
  visit("value", Real{expectation.value}, "value found; 0 if none was found, for the reason in `note`");
  visit("wanted", expectation.expected, "expectation in words");
  visit.optional("wanted_value", expectation.expected_value, "expected value, if the case has one");
  visit.optional("tolerance", expectation.tolerance, "its tolerance: absolute, the larger one of those given");
  visit.optional("minimum", expectation.minimum, "lower bound, if the case has one");
  visit.optional("maximum", expectation.maximum, "upper bound, if the case has one");
  visit("location", expectation.location, "position in the case file");
  visit("checked", expectation.checked,
        "false if it does not apply to the run (`--set`, `when`), or could not be found");
  visit("holds", expectation.holds, "whether it holds; also true if it does not apply");
  visit("note", expectation.note, "reason for which it was not or could not be checked");
}

namespace {

void describe_case(SummaryVisitor& visit, RunSummary& run) {
  visit("status", run.status, "\"running\", \"done\", \"failed\" or \"interrupted\"");
  visit("message", run.message, "reason of a failure or an interruption");
  visit("steered_by_program", run.steered, "whether a program steers it, which alone can resume it");
  visit("title", run.title, "title of the case");
  visit("case", run.case_file, "path of the case file, as given");
  visit("overrides", run.overrides, "key paths given by `--set`");
  visit("case_path", run.case_path, "absolute path of the case file, which `--resume` reads");
  visit("settings", run.settings, "settings as given to `--set`");
  visit("ricochet_version", run.version, "version of the program");
  visit("libraries", run.libraries, "versions of its libraries, its compiler, and the instruction set of its loops");
}

void describe_size(SummaryVisitor& visit, RunSummary& run) {
  visit("scheme", run.scheme, "time scheme");
  visit("mass", run.mass, "mass type that the case asks for");
  visit("mass_built", run.mass_built, "mass type that was built: for `equivalent` the one that it chose");
  visit("dimension", run.dimension, "2 or 3");
  visit("degree", run.degree, "degree of the displacement");
  visit("nodes", run.nodes, "number of nodes");
  visit("cells", run.cells, "number of cells");
  visit("dofs", run.dofs, "number of degrees of freedom");
  visit("contact_points", run.contact_points, "number of contact points");
  visit("supported_dofs", run.supported_dofs, "number of prescribed dofs");
  visit("history_every", run.history_every, "number of steps between rows of the history");
  visit("solver", run.solver, "how steps are solved: \"direct\" or \"iterative\"");
  visit("solver_reason", run.solver_reason, "reason for this");
  visit("processes", run.processes, "several processes only: sizes of their parts of the body, and their messages");
  visit("iterations", run.iterations, "iterative method only: costs per step, of this run or since it was resumed");
  visit("factor_entries", run.factor_entries, "number of entries of the factors");
}

void describe_steps(SummaryVisitor& visit, RunSummary& run) {
  visit("time_step", run.step, "length of a step; of adaptive steps the longest possible one");
  visit("adaptive_steps", run.adaptive, "adaptive steps; null if all steps have the same length");
  visit("end_time", run.end_time, "end time that the case asks for");
  visit("critical_time_step", IfKnown{std::isfinite(run.critical_step), run.critical_step},
        "longest stable step; null if any is");
  visit.derived("critical_fraction", IfKnown{std::isfinite(run.critical_step), run.step / run.critical_step},
                "`time_step` divided by it");
  visit("steps", run.steps, "number of steps that the run has reached");
  visit("steps_asked_for", run.all_steps, "number of steps of the case; of adaptive ones not known before the end");
  visit("resumed_at", run.resumed_at, "steps after which the run was resumed");
  visit("checkpoint_step", IfKnown{run.checkpoint_step >= 0, run.checkpoint_step}, "step of the last checkpoint");
  visit("instants", InstantsOf{run}, "instants of the values in a row, such as \"t +0.5 time_step\" for its time t");
  visit("frames", run.frames, "number of frames of fields");
  visit("timings_seconds", Keyed{run.timings}, "seconds of each phase of the run");
  visit("seconds_per_step", run.time_per_step, "seconds of a step");
  visit("processor_seconds", run.processor_seconds, "processor time of all threads, processes and sessions");
  visit("peak_memory_bytes", run.peak_memory, "largest memory of a process");
}

/// Visits an object whose keys are names of the parts.
template <class Part>
void describe_named(SummaryVisitor& visit, const char* name, std::vector<std::string>& names, std::vector<Part>& parts,
                    const char* text) {
  std::vector<std::pair<std::string, Part>> named;
  for (std::size_t i = 0; i < std::min(names.size(), parts.size()); ++i) named.emplace_back(names[i], parts[i]);
  visit(name, Keyed{named}, text);
  if (!visit.reads()) return;
  for (auto& [each, part] : named) {
    names.push_back(each);
    parts.push_back(part);
  }
}

}  // namespace

void describe(SummaryVisitor& visit, RunSummary& run) {
  visit.type("Summary");
  describe_case(visit, run);
  describe_size(visit, run);
  describe_steps(visit, run);
  visit.derived("energy_scale", Real{run.energy_scale()}, "largest total, kinetic or elastic energy");
  visit("energy_budget", IfKnown{run.is_recorded(), run.method_energy},
        "energy that the method lost or created, beside everything else; null before the first row of the history");
  visit("reactions", run.reactions, "contact forces that acted; null for schemes without a choice");
  visit("velocity_corrections", run.velocity_corrections,
        "corrections of the velocities that close the balance of energy of steps at finite strain; null for laws and "
        "schemes without them");
  visit("unsettled_contacts", run.unsettled,
        "contacts with large sliding where frozen steps have left gaps or overlaps");
  visit("contacts", run.contacts, "entries of `[[contact]]`, or the pairs of bodies that they stand for");
  visit("probes", run.probes, "nodes of probes");
  visit("probe_sums", run.probe_sums, "probes of boundaries and contacts");
  describe_named(visit, "extrema", run.columns, run.digests, "extrema of each column of the history, over its rows");
  std::vector<std::string> checks;
  for (const CheckResult& check : run.checks) checks.push_back(check.name);
  describe_named(visit, "checks", checks, run.checks, "balances that a run must satisfy");
  for (std::size_t i = 0; i < checks.size() && visit.reads(); ++i) run.checks[i].name = checks[i];
  visit("warnings", run.warnings, "warnings of the run");
  visit("expectations", run.expectations, "entries of `[[expect]]`, in the order of the case");
  visit("parameters", run.parameters, "all entries of the case by key path, defaults included, as texts");
  describe_results(visit, run);
}

}  // namespace ricochet
