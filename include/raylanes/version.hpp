#pragma once

/// The version of these headers, "major.minor.patch", and its parts. Until 1.0 each minor version has an interface of
/// its own. Between releases the text ends with "-dev", and the numbers name the release to come.
#define RAYLANES_VERSION "0.2.0-dev"
#define RAYLANES_VERSION_MAJOR 0
#define RAYLANES_VERSION_MINOR 2
#define RAYLANES_VERSION_PATCH 0

namespace raylanes {

/// Returns the version of the linked library, "major.minor.patch", with "-dev" between releases, in static storage.
/// If it differs from RAYLANES_VERSION, the program was compiled with the headers of another version.
const char* version() noexcept;

}  // namespace raylanes
