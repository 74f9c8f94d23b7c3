// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace raygate {

/// Makes `path` a file that holds `bytes`. The bytes go to a temporary file in the same folder,
/// reach the disk, and only then take the name, in one step: whoever looks at `path`, at whatever
/// moment and whatever fails, finds the old file or the new one, whole. Symbolic links are
/// followed; an old file's permissions are kept. A device or a pipe (/dev/stdout) is written to
/// as it is. Throws InputError ("path: cannot write: reason"), with no temporary file left.
void replace_file(const std::filesystem::path& path, std::string_view bytes);

/// Throws the InputError that `replace_file(path, ...)` would end in as things stand: folder
/// missing, no permission, a folder by that name. Changes nothing. To be called before hours of
/// work whose result goes to `path`.
void require_replaceable(const std::filesystem::path& path);

}  // namespace raygate
