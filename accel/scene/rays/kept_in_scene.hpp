// One ray in a scene whose caller rejects hits, where one tree has all that the ray's mask sees.
#pragma once

#include "../../queries/after.hpp"
#include "../lists/instance_lists.hpp"

namespace raylanes {

// The tree's kernel asks about hits of the tree. tree is null if the call takes another way.
struct KeptInCommon {
  const CommonTree* tree = nullptr;
  AskedOf<float> asked;

  KeptInCommon(const SceneParts& scene, const detail::Rejection<SceneHit>& rejection,
               const TraceOptions& options)
      : rejection_(rejection), path_(checked_path(options.path)) {
    const bool names_instance = options.skip.first == nullptr || options.skip.to_instance != 0;
    const bool is_usual = names_instance && is_usual_kept(options) && options.masks.empty();
    const CommonTree* const seen = is_usual ? quick_tree(scene, options.mask) : nullptr;
    if (seen == nullptr) return;
    require_after_in_scene(options, 1);
    const MemberNumbers numbers = seen->numbers();
    asked = {&rejects, this, options.facing};
    if (options.skip.first != nullptr) asked.skipped = numbers.of(options.skip.instance(0), options.skip[0]);
    if (options.after.first != nullptr)
      last_ = numbers.after(hit_of_after(options.after, 0)), asked.after = &last_;
    tree = seen;
  }
  KeptInCommon(const KeptInCommon&) = delete;
  KeptInCommon& operator=(const KeptInCommon&) = delete;
  TriangleOwners owners() const { return tree->numbers().owners; }
  const KeptRow<TreeView, float>& row() const { return kernels_of(path_).queries.plain.kept; }

 private:
  static bool rejects(void* call, const Hit& hit) {
    const auto& self = *static_cast<const KeptInCommon*>(call);
    return self.rejection_.rejects(self.rejection_.function, self.owners().spread(hit));
  }

  const detail::Rejection<SceneHit>& rejection_;
  const Path& path_;
  Hit last_;
};

}  // namespace raylanes
