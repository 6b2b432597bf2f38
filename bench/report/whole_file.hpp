// Files that the tool writes: each appears, or replaces an older file, only when it is complete.
#pragma once

#include <filesystem>
#include <string_view>

namespace raylanes::bench {

// Writes `bytes` to `file`. A plain file is written to a temporary in its directory and renamed over the old file,
// whose permissions it keeps. A symbolic link stays, and the file that it names is replaced. Character devices, pipes
// and descriptors such as /dev/stdout receive the bytes in place. Throws OutputError naming the file if it cannot be
// written, is a directory, a socket or a block device, or is not writable. The old file is then unchanged, without a
// temporary.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace raylanes::bench
