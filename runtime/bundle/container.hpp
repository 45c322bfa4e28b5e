#pragma once
// The container of a bundle: a tar file (POSIX ustar) that holds regular files and nothing else, in exactly one form. Whatever reads tar reads it; here
// only that form is taken, so that no two readers can see different things in it: no links, folders, devices, extensions, no second name of a file, no
// byte that means nothing. Not real-time. The reader takes any bytes.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::runtime {

/// Where the bytes of a container come from.
class ByteSource {
public:
    virtual ~ByteSource() = default;
    ByteSource() = default;
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;
    [[nodiscard]] virtual std::uint64_t size() const = 0;
    /// All of `into`, from `offset` on. Errors: bundle.unreadable.
    [[nodiscard]] virtual Result<void> read(std::uint64_t offset, std::span<std::byte> into) const = 0;
};

struct PackedFile {
    std::string path;  ///< relative, with `/`: is_packed_path()
    std::uint64_t offset = 0, size = 0;
};

struct Container {
    std::vector<PackedFile> files;  ///< in their order, no path twice
    std::int64_t stamp = 0;         ///< seconds since 1970, of every file
};

inline constexpr std::size_t most_packed_files = 4096;
inline constexpr std::uint64_t largest_packed_file = std::uint64_t{512} << 20;  ///< bytes
inline constexpr std::uint64_t largest_bundle = std::uint64_t{1} << 30;         ///< bytes
inline constexpr std::size_t longest_packed_path = 200;                         ///< bytes

/// A relative path of names with `/` between, none of them `.` or `..` or empty, without control characters and backslashes, and no longer than a bundle
/// may have.
[[nodiscard]] bool is_packed_path(std::string_view path);

/// Reads the list of files, not the files. `subject` is for messages.
/// Errors: bundle.not_a_bundle (the first block is no header of this form), bundle.damaged (a later one, or the end, is not), bundle.path, bundle.twice,
/// bundle.too_large, bundle.unreadable.
[[nodiscard]] Result<Container> read_container(const ByteSource& source, const std::string& subject);

/// The header of a regular file, 512 bytes: every archive that is made here has this one. `path`: relative, up to 255 bytes with its last part up to 100; what
/// is longer is cut at its end. `stamp`: seconds since 1970.
[[nodiscard]] std::string ustar_header(std::string_view path, std::uint64_t size, std::int64_t stamp);

/// Puts one together, in memory.
class ContainerText {
public:
    explicit ContainerText(std::int64_t stamp) : stamp_(stamp) {}
    /// Errors: bundle.path (a path that no bundle may hold, or that is too long for tar), bundle.too_large.
    [[nodiscard]] Result<void> add(const std::string& path, std::string_view bytes);
    /// The whole of it; nothing may be added afterwards.
    [[nodiscard]] std::string finish();

private:
    std::string text_;
    std::int64_t stamp_;
    std::size_t files_ = 0;
};

}  // namespace taktwerk::runtime
