#include "ricochet/run/rank_findings.hpp"

#include <algorithm>

namespace ricochet {

namespace {

void merge(const UnwatchedPenetration& other, std::vector<UnwatchedPenetration>& found) {
  const auto same = std::find_if(found.begin(), found.end(), [&](const UnwatchedPenetration& own) {
    return own.obstacle == other.obstacle && own.bodies == other.bodies && own.passed_through == other.passed_through;
  });
  if (same == found.end()) {
    found.push_back(other);
    return;
  }
  const double first_time = std::min(same->first_time, other.first_time);
  if (other.depth > same->depth) *same = other;
  same->first_time = first_time;
}

/// Keeps the larger share; shares refer to the contact force on one process.
void merge(const UnsettledContact& other, std::vector<UnsettledContact>& contacts) {
  const auto same = std::find_if(contacts.begin(), contacts.end(),
                                 [&](const UnsettledContact& own) { return own.contact == other.contact; });
  if (same == contacts.end()) {
    contacts.push_back(other);
  } else if (other.share > same->share) {
    *same = other;
  }
}

void merge(const ContactBeyondRim& other, std::vector<ContactBeyondRim>& rims) {
  const auto same = std::find_if(rims.begin(), rims.end(), [&](const ContactBeyondRim& own) {
    return own.group == other.group && own.obstacle == other.obstacle;
  });
  if (same == rims.end()) {
    rims.push_back(other);
  } else if (other.time < same->time) {
    *same = other;
  }
}

}  // namespace

void merge_findings(const RunSummary& other, RunSummary& summary) {
  for (const UnwatchedPenetration& each : other.penetration.found) merge(each, summary.penetration.found);
  for (const ContactBeyondRim& each : other.penetration.rims) merge(each, summary.penetration.rims);
  for (const UnsettledContact& each : other.unsettled) merge(each, summary.unsettled);
  if (!other.peak_stress) return;
  if (!summary.peak_stress || other.peak_stress->peak.von_mises > summary.peak_stress->peak.von_mises)
    summary.peak_stress = other.peak_stress;
}

}  // namespace ricochet
