// The sources and options that the tool was built from.
#pragma once

namespace raylanes::bench {

struct BuildFacts {
  const char*
      commit;  // of git, with "-dirty" behind it where files differ; the version where there is no git
  const char* build_type;  // of Meson
  const char* flags;       // optimization, sanitizers and what the builder added
};
extern const BuildFacts build_facts;

}  // namespace raylanes::bench
