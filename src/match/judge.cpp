#include "match/judge.hpp"

#include "match/align.hpp"
#include "match/refine.hpp"
#include "match/verify.hpp"

namespace rejoin::match {

bool fits(const Joint& joint, const Rigid& pose) {
  const Evidence evidence = joint.agreed_evidence(pose);
  return score_of(strength(evidence)) >= kSure &&
         score_of(strength(told_by_scale(evidence, joint.scales(pose)))) >= kSure;
}

Candidate judge(const Fragment& a, const Fragment& b, const Rigid& pose) {
  const Joint fresh(a, b);
  const Rigid at = to_origins(a, b, pose);
  Evidence evidence = weigh(fresh.agreed_evidence(at), fresh, at);
  if (tell_wear(a, b) && !fits(fresh, at)) {
    const Joint joint = fresh.worn();
    const Evidence worn = weigh(joint.agreed_evidence(at), joint, at);
    if (strength(worn) > strength(evidence)) evidence = worn;
  }
  return unmeasured(a, b, at, evidence, strength(evidence));
}

}  // namespace rejoin::match
