#include <string_view>

#include <raylanes/version.hpp>

namespace raylanes {
namespace {

#define RAYLANES_TEXT_OF(x) #x
#define RAYLANES_TEXT(x) RAYLANES_TEXT_OF(x)
constexpr std::string_view parts = RAYLANES_TEXT(RAYLANES_VERSION_MAJOR) "." RAYLANES_TEXT(
    RAYLANES_VERSION_MINOR) "." RAYLANES_TEXT(RAYLANES_VERSION_PATCH);
constexpr std::string_view version_text = RAYLANES_VERSION;
static_assert(version_text.substr(0, version_text.find('-')) == parts);
static_assert(version_text == RAYLANES_PROJECT_VERSION,
              "version.hpp and meson.build name different versions");

}  // namespace

const char* version() noexcept {
  return RAYLANES_VERSION;
}

}  // namespace raylanes
