#include "match/judge.hpp"

#include "match/refine.hpp"
#include "match/verify.hpp"

namespace rejoin::match {

Judged judge(const Joint& joint, const Rigid& pose) {
  const Evidence evidence = joint.agreed_evidence(pose);
  const Weighed weighed = weigh(evidence, joint, pose);
  Judged result{weighed.evidence, weighed.as_rival, strength(evidence)};
  if (result.as_rival > kEven) hold_sliding(result.evidence, joint, pose);
  return result;
}

Judged judge(const Fragment& a, const Fragment& b, const Rigid& pose) {
  const Joint joint(a, b);
  const Rigid at = to_origins(a, b, pose);
  const Judged fresh = judge(joint, at);
  if (!tell_wear(a, b) || score_of(fresh.fit) >= kSure) return fresh;
  const Judged worn = judge(joint.worn(), at);
  return strength(worn.evidence) > strength(fresh.evidence) ? worn : fresh;
}

}  // namespace rejoin::match
