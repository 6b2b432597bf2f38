#include "sequence.hpp"

#include "../../contenders/embree/embree_contender.hpp"
#include "../../contenders/workload.hpp"
#include "../../report/exits.hpp"
#include "../oracles/exact_rays.hpp"
#include "../rulers/progress.hpp"
#include "mesh_reader.hpp"

namespace raylanes::bench {

Follower::Follower(MotionPolicy policy, const Mesh& first, int threads) : policy_(policy), threads_(threads) {
  build(first);
}

void Follower::build(const Mesh& frame) {
  build_seconds_ = seconds_of([&] { tree_ = Bvh(frame, {.threads = threads_}); });
  lost_ = 0;
}

double Follower::expected_loss() const {
  return fresh_trace_seconds_ * std::max(0.0, tree_.decay() - 1);
}

bool Follower::follow(const Mesh& frame) {
  bool is_built = policy_ == MotionPolicy::rebuild;
  if (!is_built) {
    tree_.refit(frame.vertices, frame.triangles, threads_);
    if (policy_ == MotionPolicy::automatic) {
      lost_ += expected_loss();
      is_built = lost_ > build_seconds_;
    }
  }
  if (is_built) build(frame);
  return is_built;
}

void Follower::traced(double seconds) {
  fresh_trace_seconds_ = seconds / std::max(1.0, tree_.decay());
}

namespace {

constexpr std::size_t checked_rays = 48;  // of a frame

Mesh side_by_side(const Mesh& mesh, std::size_t copies, float distance) {
  Mesh all;
  for (std::size_t copy = 0; copy < copies; ++copy) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    for (Float3 vertex : mesh.vertices) {
      vertex[0] += static_cast<float>(copy) * distance;
      all.vertices.push_back(vertex);
    }
    for (const Index3& triangle : mesh.triangles)
      all.triangles.push_back({triangle[0] + first, triangle[1] + first, triangle[2] + first});
  }
  return all;
}

// The rays that all policies trace in a frame: primary rays, then diffuse ones.
struct Frame {
  std::size_t number;
  const Mesh& mesh;
  std::vector<Ray> rays;
  std::size_t primary_count;
};

Frame frame_of(const Sequence& sequence, std::size_t number, const SequenceOptions& options) {
  const Scene scene{sequence.name, sequence.frames[number], sequence.camera};
  const Workload workload(scene, Bvh(scene.mesh), options.width, options.height);
  Frame frame{number, sequence.frames[number], workload.primary(), workload.primary().size()};
  const std::vector<Ray> diffuse = workload.rays(RayKind::diffuse).rays;
  frame.rays.insert(frame.rays.end(), diffuse.begin(), diffuse.end());
  return frame;
}

// One turn of a policy in a frame.
struct Turn {
  bool is_built = false;
  double update = 0, primary = 0, diffuse = 0;  // seconds
  std::vector<Hit> hits;

  double total() const { return update + primary + diffuse; }
};

Turn take_turn(Follower& follower, const Frame& frame, const SequenceOptions& options) {
  Turn turn;
  if (frame.number > 0) turn.update = seconds_of([&] { turn.is_built = follower.follow(frame.mesh); });
  turn.hits.resize(frame.rays.size());
  const auto trace = [&](std::size_t begin, std::size_t end) {
    const auto rays = std::span(frame.rays).subspan(begin, end - begin);
    const auto hits = std::span(turn.hits).subspan(begin, end - begin);
    return seconds_of(
        [&] { follower.tree().closest(rays, hits, {.path = options.path, .threads = options.threads}); });
  };
  turn.primary = trace(0, frame.primary_count);
  turn.diffuse = trace(frame.primary_count, frame.rays.size());
  follower.traced(turn.primary + turn.diffuse);
  return turn;
}

bool same_bytes(std::span<const Hit> a, std::span<const Hit> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

// Some of the hits against exact arithmetic over all triangles; returns how many.
std::size_t check(const Frame& frame, std::span<const Hit> hits) {
  std::vector<Ray> rays;
  std::vector<Hit> ours;
  for (std::size_t i = 0; i < checked_rays; ++i) {
    const std::size_t at = i * hits.size() / checked_rays;
    rays.push_back(frame.rays[at]), ours.push_back(hits[at]);
  }
  if (!same_bytes(ours, oracle::nearest_hits(frame.mesh, rays)))
    throw WrongAnswers("trees --frames: frame " + std::to_string(frame.number) +
                       ": hits are not those of exact arithmetic over all triangles");
  return rays.size();
}

double median_of(const std::vector<double>& numbers) {
  return quartiles_of(numbers).median;
}

double mrays(std::size_t rays, double seconds) {
  return 1e-6 * static_cast<double>(rays) / seconds;
}

// All policies, round after round.
class Rounds {
 public:
  Rounds(const Sequence& sequence, const SequenceOptions& options)
      : sequence_(sequence),
        options_(options),
        turns_(sequence.frames.size() * options.policies.size()),
        totals_(options.policies.size()) {}

  SequenceTrace run() {
    ProgressLine progress(sequence_.name);
    for (int round = 0; round < options_.rounds; ++round) {
      run_round(round);
      progress.update(static_cast<double>(round + 1) / options_.rounds);
    }
    for (std::size_t p = 0; p < options_.policies.size(); ++p) add_policy(p);
    return std::move(result_);
  }

 private:
  // The times of all rounds.
  struct Turns {
    FrameRow row;
    std::vector<double> update, primary, diffuse;
  };

  void run_round(int round) {
    std::vector<Follower> followers;
    for (const MotionPolicy policy : options_.policies)
      followers.emplace_back(policy, sequence_.frames[0], options_.threads);
    for (std::vector<double>& total : totals_) total.push_back(0);
    for (std::size_t number = 0; number < sequence_.frames.size(); ++number) {
      const Frame frame = frame_of(sequence_, number, options_);
      std::vector<Hit> expected;
      for (std::size_t turn = 0; turn < followers.size(); ++turn) {
        const std::size_t p = (turn + number + static_cast<std::size_t>(round)) % followers.size();
        Turn taken = take_turn(followers[p], frame, options_);
        if (number > 0) record(frame, p, followers[p].tree(), taken);
        if (turn == 0)
          expected = std::move(taken.hits);
        else if (!same_bytes(expected, taken.hits))
          throw WrongAnswers("trees --frames: frame " + std::to_string(number) +
                             ": hits differ between policies");
      }
      if (round == 0) result_.checked += check(frame, expected);
    }
  }

  void record(const Frame& frame, std::size_t policy, const Bvh& tree, const Turn& turn) {
    Turns& turns = turns_[frame.number * options_.policies.size() + policy];
    turns.row.frame = frame.number;
    turns.row.policy = motion_policy_names[static_cast<std::size_t>(options_.policies[policy])];
    turns.row.is_built = turn.is_built;
    turns.row.primary_rays = frame.primary_count;
    turns.row.diffuse_rays = frame.rays.size() - frame.primary_count;
    turns.row.decay = tree.decay(), turns.row.sah_cost = tree.sah_cost();
    turns.update.push_back(turn.update);
    turns.primary.push_back(turn.primary);
    turns.diffuse.push_back(turn.diffuse);
    totals_[policy].back() += turn.total();
  }

  void add_policy(std::size_t policy) {
    PolicyRow all;
    all.policy = motion_policy_names[static_cast<std::size_t>(options_.policies[policy])];
    all.total_seconds = quartiles_of(totals_[policy]);
    std::vector<double> update, primary, diffuse;
    for (std::size_t number = 1; number < sequence_.frames.size(); ++number) {
      Turns& turns = turns_[number * options_.policies.size() + policy];
      turns.row.update_seconds = median_of(turns.update);
      turns.row.primary_seconds = median_of(turns.primary);
      turns.row.diffuse_seconds = median_of(turns.diffuse);
      result_.frames.push_back(turns.row);
      update.push_back(turns.row.update_seconds);
      primary.push_back(mrays(turns.row.primary_rays, turns.row.primary_seconds));
      diffuse.push_back(mrays(turns.row.diffuse_rays, turns.row.diffuse_seconds));
      all.frames += 1, all.builds += turns.row.is_built ? 1 : 0;
    }
    all.update_seconds = median_of(update);
    all.primary_mrays = median_of(primary), all.diffuse_mrays = median_of(diffuse);
    if (options_.policies[policy] == MotionPolicy::automatic) all.ratio_to_best_fixed = ratio_of(policy);
    result_.policies.push_back(all);
  }

  // Nothing unless both fixed policies are requested.
  std::optional<Quartiles> ratio_of(std::size_t policy) const {
    const auto totals_of = [&](MotionPolicy fixed) -> const std::vector<double>* {
      const auto at = std::find(options_.policies.begin(), options_.policies.end(), fixed);
      return at == options_.policies.end()
                 ? nullptr
                 : &totals_[static_cast<std::size_t>(at - options_.policies.begin())];
    };
    const std::vector<double>*const refit = totals_of(MotionPolicy::refit), *const rebuild = totals_of(
                                                                                MotionPolicy::rebuild);
    if (refit == nullptr || rebuild == nullptr) return {};
    const auto& best = median_of(*refit) < median_of(*rebuild) ? *refit : *rebuild;
    std::vector<double> ratios;
    for (std::size_t round = 0; round < best.size(); ++round)
      ratios.push_back(totals_[policy][round] / best[round]);
    return quartiles_of(ratios);
  }

  const Sequence& sequence_;
  const SequenceOptions& options_;
  std::vector<Turns> turns_;                 // [frame][policy]
  std::vector<std::vector<double>> totals_;  // [policy][round]
  SequenceTrace result_;
};

}  // namespace

Sequence load_sequence(const std::vector<std::string>& files, std::size_t copies) {
  if (files.size() < 2)
    throw std::invalid_argument("trees --frames: " + std::to_string(files.size()) +
                                " frame, at least two are needed");
  const Scene first = load_scene(files[0]);
  const auto distance = static_cast<float>(diagonal_of(first.mesh));
  Sequence sequence{first.name, first.camera, {side_by_side(first.mesh, copies, distance)}};
  for (std::size_t i = 1; i < files.size(); ++i) {
    const Mesh mesh = read_mesh(files[i]);
    if (mesh.triangles.size() != first.mesh.triangles.size())
      throw std::invalid_argument(files[i] + ": " + std::to_string(mesh.triangles.size()) +
                                  " triangles, the first frame has " +
                                  std::to_string(first.mesh.triangles.size()));
    sequence.frames.push_back(side_by_side(mesh, copies, distance));
  }
  if (copies > 1) sequence.camera = automatic_camera(sequence.frames[0]);
  return sequence;
}

SequenceTrace trace_sequence(const Sequence& sequence, const SequenceOptions& options) {
  return Rounds(sequence, options).run();
}

RefitTimes refit_beside_embree(const Sequence& sequence, int rounds) {
  const Mesh& first = sequence.frames[0];
  Bvh ours(first);
  EmbreeContender embree(first.vertices, first.triangles, "", EmbreeBuild::refitted);
  std::vector<std::vector<double>> our_times(sequence.frames.size()), embree_times(sequence.frames.size());
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round)
    for (std::size_t frame = 1; frame < sequence.frames.size(); ++frame) {
      const Mesh& mesh = sequence.frames[frame];
      our_times[frame].push_back(seconds_of([&] { ours.refit(mesh.vertices, mesh.triangles); }));
      embree_times[frame].push_back(embree.move(mesh.vertices));
      ratios.push_back(embree_times[frame].back() / our_times[frame].back());
    }
  RefitTimes times{.ours = {}, .embree = {}, .ratio = quartiles_of(ratios)};
  for (std::size_t frame = 1; frame < sequence.frames.size(); ++frame) {
    times.ours.push_back(quartiles_of(our_times[frame]).median);
    times.embree.push_back(quartiles_of(embree_times[frame]).median);
  }
  return times;
}

}  // namespace raylanes::bench
