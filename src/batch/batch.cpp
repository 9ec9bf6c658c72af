#include "batch/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "batch/inputs.hpp"
#include "batch/matcher_source.hpp"
#include "batch/pace.hpp"
#include "batch/search_pair.hpp"
#include "batch/shelf.hpp"
#include "batch/sizes.hpp"
#include "batch/table.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/parallel.hpp"
#include "core/version.hpp"

namespace rejoin::batch {
namespace fs = std::filesystem;
namespace {

struct PairOfIndices {
  std::size_t a;
  std::size_t b;
};

template <class Visit>
void for_each_pair(const Tile& tile, const Visit& visit) {
  for (std::size_t a = tile.a_first; a < tile.a_last; ++a) {
    for (std::size_t b = std::max(a + 1, tile.b_first); b < tile.b_last; ++b) visit(PairOfIndices{a, b});
  }
}

/// The work of one call of run(), with what it needs at hand.
class Work {
 public:
  Work(const fs::path& inputs, const fs::path& output, const Options& options, Listener& listener,
       const Context& context)
      : inputs_(inputs),
        output_(output),
        options_(options),
        listener_(listener),
        context_(context),
        scans_(find_scans(inputs)),
        untellable_(untellable_scans(inputs)),
        names_(names_of(scans_)),
        equal_sized_(files_of_equal_size(scans_)),
        run_(open(output)),
        parameters_{version(), parameters_json(options.match, options.kind), options.match.seed},
        copies_(copies()),
        layout_(without_copies(options.layout)),
        painted_(without_copies(options.painted)),
        tiles_(tiles_of(take_copies_off(), options.shard)),
        shelf_(output / kCacheName, options.kind) {}

  Summary run() {
    begin();
    for (const Tile& tile : tiles_) {
      if (context_.cancelled()) break;
      do_tile(tile);
    }
    write_table(run_, output_ / kTableName);
    return summary();
  }

 private:
  store::Run open(const fs::path& output) const {
    if (scans_.size() - store::copies(equal_sized_).size() < 2) {
      throw InputError(inputs_.string(), "holds one scan only, under several names",
                       "give a folder of different scans");
    }
    require_writable_folder(output / kCacheName);
    return store::Run::write(output);
  }

  /// Pairs of other parameters are done again anyhow.
  std::map<std::string, std::string> copies() const {
    if (run_.parameters() != parameters_) return store::copies(equal_sized_);
    return run_.copies_among(with_unreadable(equal_sized_), shard_name());
  }

  /// A scan that cannot be read now, as on a disk that is not mounted, is what the run knows of it, and its copies stay copies.
  std::vector<store::Fragment> with_unreadable(std::vector<store::Fragment> files) const {
    std::map<std::string, std::vector<std::string>> of_hash;
    std::set<std::string> unreadable;
    for (const store::Fragment& known : run_.fragments()) {
      const auto scan = scans_.find(known.name);
      if (scan == scans_.end() || known.hash == store::kUnreadable) continue;
      of_hash[known.hash].push_back(known.name);
      if (!std::ifstream(scan->second)) unreadable.insert(known.name);
    }
    std::erase_if(files, [&](const store::Fragment& file) { return unreadable.count(file.name) != 0; });
    for (const auto& [hash, names] : of_hash) {
      if (std::ranges::none_of(names, [&](const auto& name) { return unreadable.count(name) != 0; }))
        continue;
      for (const std::string& name : names) {
        if (std::ranges::any_of(files, [&](const auto& file) { return file.name == name; })) continue;
        store::Fragment& file = files.emplace_back();
        file.name = name;
        file.hash = unreadable.count(name) != 0 ? hash : hash_if_readable(scans_.at(name));
      }
    }
    return files;
  }

  /// As store::Run::shard() tells it.
  std::string shard_name() const {
    const Shard& shard = options_.shard;
    return shard.count > 1 ? fmt::format("{}/{}", shard.number, shard.count) : "";
  }

  /// What the user says of a copy holds for what stands for it.
  template <class Value>
  std::map<std::string, Value> without_copies(std::map<std::string, Value> said) const {
    for (const auto& [copy, first] : copies_) {
      const auto of_copy = said.extract(copy);
      if (!of_copy.empty()) said.try_emplace(first, of_copy.mapped());
    }
    return said;
  }

  /// \return how many names stay
  std::size_t take_copies_off() {
    names_.erase(std::remove_if(names_.begin(), names_.end(),
                                [this](const std::string& name) { return copies_.count(name) != 0; }),
                 names_.end());
    return names_.size();
  }

  /// Brings the database to the inputs and options of this run.
  void begin() {
    std::vector<store::Fragment> wanted = describe_inputs();
    const auto forgotten = run_.begin(parameters_, wanted, shard_name());
    if (options_.retry) run_.forget_failures();
    for (const store::Fragment& fragment : run_.fragments()) fragments_[fragment.name] = fragment;
    count_done();
    listener_.on_start(forgotten, progress_);
    for (const std::string& warning : options_.warnings) listener_.on_warning(warning, progress_);
    for (const std::string& left_out : {told_of_models(inputs_), told_of_painted(inputs_),
                                        told_of_folders(inputs_), told_of_formats(inputs_)}) {
      if (!left_out.empty()) listener_.on_warning(left_out, progress_);
    }
    for (const auto& [copy, first] : copies_) {
      if (fragments_.count(copy) == 0) continue;
      listener_.on_warning(store::told_of_copy(copy, first), progress_);
    }
    for (const auto& [name, fragment] : fragments_) {
      if (fragment.state == store::FragmentState::Bad) listener_.on_fragment(fragment, progress_);
    }
    for (const store::Fragment& scan : untellable_) listener_.on_fragment(scan, progress_);
    warn_of_sizes();
  }

  /// Whether the folder, or the user, has no pair end at the sweep.
  bool all_in_full() const { return !options_.match.promising_only || names_.size() <= options_.few_scans; }

  /// Of this shard's pairs alone: with other scans in the folder the shard was another one, and what it did then is kept too.
  /// Pairs that ended at the sweep among more scans are not done among few.
  void count_done() {
    std::set<std::pair<std::int64_t, std::int64_t>> failed;
    for (const store::Run::Done& pair : run_.done()) {
      if (pair.stage == store::Stage::Sweep && all_in_full()) continue;
      (pair.stage == store::Stage::Failed ? failed : done_).emplace(pair.a, pair.b);
    }
    done_.insert(failed.begin(), failed.end());
    for (const Tile& tile : tiles_) {
      for_each_pair(tile, [&](const PairOfIndices& pair) {
        ++progress_.total;
        progress_.done += done_.count(ids_of(pair));
        progress_.failed += failed.count(ids_of(pair));
      });
    }
    if (progress_.done == progress_.total) progress_.seconds_left = 0.0;
    done_before_ = progress_.done;
  }

  /// Once of each scan, as soon as sizes are known; of units once those of all are.
  void warn_of_sizes() {
    std::vector<store::Fragment> known;
    bool all_known = true;
    for (const auto& [name, fragment] : fragments_) {
      known.push_back(fragment);
      all_known = all_known && (fragment.state != store::FragmentState::Waiting || copies_.count(name) != 0);
    }
    if (all_known && !units_looked_at_) {
      units_looked_at_ = true;
      const OddUnit unit = odd_unit(known);
      if (!unit.fragments.empty()) listener_.on_warning(told(unit), progress_);
      for (const store::Fragment& fragment : unit.fragments) doubted_.insert(fragment.name);
      CoarseAmongSherds coarse = coarse_among_sherds(known);
      std::erase_if(coarse.fragments,
                    [this](const auto& fragment) { return doubted_.count(fragment.name) > 0; });
      if (!coarse.fragments.empty()) listener_.on_warning(told(coarse), progress_);
    }
    OddSizes odd = odd_sizes(known);
    odd.fragments.erase(
        std::remove_if(odd.fragments.begin(), odd.fragments.end(),
                       [this](const auto& fragment) { return !doubted_.insert(fragment.name).second; }),
        odd.fragments.end());
    if (!odd.fragments.empty()) listener_.on_warning(told(odd), progress_);
  }

  /// Name, path and hash of the fragments of this shard, of their copies, and of those in the folder that the run knows: they were of
  /// this shard before others came or went, and what was done then stays.
  std::vector<store::Fragment> describe_inputs() const {
    std::set<std::size_t> indices;
    for (const Tile& tile : tiles_) {
      for (const std::size_t k : tile.fragments()) indices.insert(k);
    }
    std::set<std::string> needed;
    for (const std::size_t k : indices) needed.insert(names_[k]);
    for (const auto& [copy, first] : copies_) {
      if (needed.count(first) != 0) needed.insert(copy);
    }
    for (const store::Fragment& known : run_.fragments()) {
      if (scans_.count(known.name) != 0) needed.insert(known.name);
    }
    std::map<std::string, std::string> hashes;
    for (const store::Fragment& file : equal_sized_) hashes[file.name] = file.hash;
    std::vector<store::Fragment> list;
    list.reserve(needed.size());
    for (const std::string& name : needed) {
      store::Fragment fragment;
      fragment.name = name;
      fragment.path = fs::absolute(scans_.at(name)).lexically_normal().string();
      fragment.hash = hashes[name];
      if (const auto laid = layout_.find(name); laid != layout_.end())
        fragment.pose = pose_text(laid->second);
      if (const auto file = painted_.find(name); file != painted_.end())
        fragment.facets = keep_painted(file->second, output_ / kCacheName);
      list.push_back(std::move(fragment));
    }
    run_side_by_side(list.size(), [&](std::size_t k) {
      // One that cannot be read becomes a bad fragment when it is loaded, and a changed one once it can be read.
      if (list[k].hash.empty()) list[k].hash = hash_if_readable(list[k].path);
    });
    return list;
  }

  void do_tile(const Tile& tile) {
    const std::vector<PairOfIndices> pending = pending_of(tile);
    if (pending.empty()) return;
    std::set<std::size_t> needed;
    for (const PairOfIndices& pair : pending) needed.insert({pair.a, pair.b});
    std::vector<store::Fragment> wanted;
    wanted.reserve(needed.size());
    for (const std::size_t k : needed) wanted.push_back(fragments_.at(names_[k]));
    shelf_.hold(wanted, context_, [this](const store::Fragment& fragment, const auto& warnings) {
      take(fragment);
      for (const std::string& warning : warnings) listener_.on_warning(warning, progress_);
    });
    warn_of_sizes();
    if (progress_.done == done_before_) pace_.start();
    run_side_by_side(pending.size(), [&](std::size_t k) {
      if (!context_.cancelled()) do_pair(pending[k]);
    });
  }

  std::vector<PairOfIndices> pending_of(const Tile& tile) const {
    std::vector<PairOfIndices> pending;
    for_each_pair(tile, [&](const PairOfIndices& pair) {
      if (done_.count(ids_of(pair)) == 0) pending.push_back(pair);
    });
    return pending;
  }

  std::pair<std::int64_t, std::int64_t> ids_of(const PairOfIndices& pair) const {
    return {fragments_.at(names_[pair.a]).id, fragments_.at(names_[pair.b]).id};
  }

  void do_pair(const PairOfIndices& indices) {
    const store::Fragment& a = fragments_.at(names_[indices.a]);
    const store::Fragment& b = fragments_.at(names_[indices.b]);
    const match::Fragment* prepared_a = shelf_.find(a.name);
    const match::Fragment* prepared_b = shelf_.find(b.name);
    std::optional<Searched> found;
    if (prepared_a != nullptr && prepared_b != nullptr) {
      const Context alone({}, context_);
      found = search_pair(*prepared_a, *prepared_b, options_of(a.name, b.name), alone);
    } else if (!context_.cancelled()) {
      found = unusable(prepared_a == nullptr ? a : b);
    }
    if (!found) return;
    found->pair.a = a.id;
    found->pair.b = b.id;
    found->pair.name_a = a.name;
    found->pair.name_b = b.name;
    keep(*found);
  }

  match::Options options_of(const std::string& a, const std::string& b) const {
    match::Options options = options_.match;
    if (all_in_full()) options.promising_only = false;
    const auto laid_a = layout_.find(a);
    const auto laid_b = layout_.find(b);
    if (laid_a == layout_.end() || laid_b == layout_.end()) return options;
    options.near = inverse(laid_a->second) * laid_b->second;
    options.promising_only = false;
    return options;
  }

  static Searched unusable(const store::Fragment& fragment) {
    Searched found;
    found.pair.error = fragment.error;
    found.pair.result = "{}";
    return found;
  }

  void keep(const Searched& found) {
    const std::lock_guard lock(guard_);
    run_.save(found.pair, found.candidates);
    ++progress_.done;
    progress_.failed += found.pair.stage == store::Stage::Failed ? 1 : 0;
    progress_.seconds_left = pace_.done_one(progress_.total - progress_.done);
    listener_.on_pair(found.pair, progress_);
  }

  void take(const store::Fragment& fragment) {
    const std::lock_guard lock(guard_);
    store::Fragment& known = fragments_.at(fragment.name);
    if (known != fragment) run_.save(fragment);
    known = fragment;
    listener_.on_fragment(fragment, progress_);
  }

  Summary summary() {
    Summary summary;
    summary.bad = untellable_;
    summary.fragments = fragments_.size();
    for (const auto& [copy, first] : copies_) summary.copies += fragments_.count(copy);
    for (const auto& [name, fragment] : fragments_) {
      if (fragment.state == store::FragmentState::Bad) summary.bad.push_back(fragment);
    }
    summary.done_before = done_before_;
    summary.progress = progress_;
    summary.cancelled = context_.cancelled();
    return summary;
  }

  fs::path inputs_;
  fs::path output_;
  const Options& options_;
  Listener& listener_;
  const Context& context_;
  Scans scans_;                               // copies, too
  std::vector<store::Fragment> untellable_;   // left out of these
  std::vector<std::string> names_;            // of the scans that have pairs
  std::vector<store::Fragment> equal_sized_;  // name and hash
  store::Run run_;
  store::Parameters parameters_;
  std::map<std::string, std::string> copies_;  // of the others, with the names that stand for them
  Layout layout_;                              // of scans that have pairs
  Painted painted_;                            // of these
  std::vector<Tile> tiles_;
  Shelf shelf_;
  std::map<std::string, store::Fragment> fragments_;
  std::set<std::pair<std::int64_t, std::int64_t>> done_;
  std::set<std::string> doubted_;  // names of which warn_of_sizes() has told
  bool units_looked_at_ = false;   // by warn_of_sizes()
  std::size_t done_before_ = 0;
  Progress progress_;
  Pace pace_;
  std::mutex guard_;  // of run_, fragments_, progress_ and the listener while several threads work
};

}  // namespace

std::string matcher() {
  return kMatcherSource;
}

std::string version() {
  return fmt::format("{} (matcher {})", kVersion, matcher());
}

Summary run(const fs::path& inputs, const fs::path& output, const Options& options, Listener& listener,
            const Context& context) {
  return Work(inputs, output, options, listener, context).run();
}

}  // namespace rejoin::batch
