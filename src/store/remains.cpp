#include "store/remains.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "core/words.hpp"

namespace rejoin::store {
namespace {

std::string ended_early(std::size_t pairs, std::size_t all) {
  return fmt::format(
      "{} of its {} looked hopeless soon and {} not searched in full (rejoin batch --thorough does)", pairs,
      counted(all, "pair"), pairs == 1 ? "was" : "were");
}

std::string apart(std::size_t pairs, std::size_t all) {
  const std::string these = pairs == all ? fmt::format("none of its {} was", counted(all, "pair"))
                                         : fmt::format("{} of its {} {} not", pairs, counted(all, "pair"),
                                                       pairs == 1 ? "was" : "were");
  return these + " searched, as the layout has them too far apart to touch";
}

std::string not_compared(std::size_t missing, const char* of, std::size_t all) {
  return fmt::format("{} of {}{} {} not compared yet", missing, of, counted(all, "pair"),
                     missing == 1 ? "is" : "are");
}

}  // namespace

Remains remains(const Run& run) {
  const std::vector<Fragment> fragments = run.fragments();
  const std::map<std::string, std::string> left_out = run.copies();
  std::map<std::int64_t, std::size_t> missing;  // by id
  std::map<std::int64_t, std::size_t> early;
  std::map<std::int64_t, std::size_t> apart;
  const std::size_t count = fragments.size() - left_out.size();
  Remains result;
  result.shard = run.shard();
  result.pairs_each = count > 0 ? count - 1 : 0;
  result.pairs = result.missing = count * result.pairs_each / 2;
  for (const Fragment& fragment : fragments)
    if (left_out.count(fragment.name) == 0) missing[fragment.id] = result.pairs_each;
  for (const Run::Done& pair : run.done()) {
    const auto a = missing.find(pair.a);
    const auto b = missing.find(pair.b);
    if (a == missing.end() || b == missing.end()) continue;
    --a->second;
    --b->second;
    --result.missing;
    if (pair.stage == Stage::Apart) ++result.apart;
    for (const std::int64_t id : {pair.a, pair.b}) {
      if (pair.stage == Stage::Sweep) ++early[id];
      if (pair.stage == Stage::Apart) ++apart[id];
    }
  }
  for (const Fragment& fragment : fragments) {
    const auto at = missing.find(fragment.id);
    if (at != missing.end() && at->second > 0) result.missing_of[fragment.name] = at->second;
    const auto soon = early.find(fragment.id);
    if (soon != early.end()) result.ended_early_of[fragment.name] = soon->second;
    const auto far = apart.find(fragment.id);
    if (far != apart.end()) result.apart_of[fragment.name] = far->second;
  }
  return result;
}

std::string told(const Remains& remains) {
  if (remains.missing == 0 && remains.shard.empty()) return "";
  if (remains.missing == 0)
    return fmt::format("this is shard {} only, rejoin merge puts it together with the others", remains.shard);
  return not_compared(remains.missing, "", remains.pairs) +
         (remains.shard.empty()
              ? "; rejoin batch goes on with them"
              : fmt::format("; this is shard {}, rejoin merge puts it together with the others",
                            remains.shard));
}

std::string told(const Remains& remains, const std::string& fragment) {
  const auto at = remains.missing_of.find(fragment);
  const auto far = remains.apart_of.find(fragment);
  const auto soon = remains.ended_early_of.find(fragment);
  if (at != remains.missing_of.end() && at->second == remains.pairs_each)
    return fmt::format("none of its {} is compared yet", counted(at->second, "pair"));
  std::string text;
  const auto add = [&text](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  if (at != remains.missing_of.end()) add(not_compared(at->second, "its ", remains.pairs_each));
  if (far != remains.apart_of.end()) add(apart(far->second, remains.pairs_each));
  if (soon != remains.ended_early_of.end()) add(ended_early(soon->second, remains.pairs_each));
  return text;
}

bool is_searched(const Remains& remains) {
  return remains.pairs == 0 || remains.missing + remains.apart < remains.pairs;
}

bool is_searched(const Remains& remains, const std::string& fragment) {
  const auto count = [&fragment](const std::map<std::string, std::size_t>& of) {
    const auto at = of.find(fragment);
    return at == of.end() ? 0 : at->second;
  };
  const std::size_t not_searched = count(remains.missing_of) + count(remains.apart_of);
  return not_searched == 0 || not_searched < remains.pairs_each;
}

}  // namespace rejoin::store
