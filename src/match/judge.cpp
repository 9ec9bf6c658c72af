#include "match/judge.hpp"

#include "match/align.hpp"
#include "match/refine.hpp"
#include "match/verify.hpp"

namespace rejoin::match {

Candidate judge(const Fragment& a, const Fragment& b, const Rigid& pose) {
  const Joint joint(a, b);
  const Rigid at = to_origins(a, b, pose);
  const Evidence evidence = weigh(joint.agreed_evidence(at), joint, at);
  return unmeasured(a, b, at, evidence, strength(evidence));
}

}  // namespace rejoin::match
