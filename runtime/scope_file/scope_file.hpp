#pragma once
// Rows of signals as a file, `.twscope`. Not real-time.
//
// Format, little-endian: "TWSCOPE" 00h, version u32, length of the head u32, the head (JSON, scope_head.hpp), CRC-32 of version, length and
// head u32. Then blocks: rows u32 (1 to 4096), length u32, CRC-32 of these and the bytes u32, that many bytes: one zstd frame. Decompressed it is
// words * rows * 8 bytes: for each word of the row 8 planes, the lowest bytes first, one byte a row of the difference to the row before
// (of the first row in the block: to 0). The last block has 0 rows and 8 bytes, the number of all rows as u64: a file without it was cut off.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "core/result.hpp"
#include "runtime/scope_file/kept_rows.hpp"
#include "runtime/scope_file/scope_head.hpp"

namespace taktwerk::runtime {

inline constexpr std::string_view scope_ending = ".twscope";
inline constexpr std::uint32_t scope_version = 1, most_block_rows = 4096, most_head_bytes = 16 << 20;

/// Writes block by block: no more than one is in memory. Errors of all members: recording.write, with the system's reason.
class ScopeFileWriter {
public:
    [[nodiscard]] static Result<ScopeFileWriter> create(const std::string& path, const ScopeHead& head);
    /// `columns`: 1 to most_block_rows rows, all of the first word, then all of the second.
    [[nodiscard]] Result<void> write(std::span<const std::uint64_t> columns);
    /// The end mark. True only when all of it is on the disk. Nothing may follow.
    [[nodiscard]] Result<void> finish();
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }
    [[nodiscard]] std::uint64_t rows() const noexcept { return rows_; }

private:
    struct Close {
        void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    };
    ScopeFileWriter(std::string path, std::FILE* file, std::size_t words) : path_(std::move(path)), file_(file), words_(words) {}
    [[nodiscard]] Result<void> put(std::span<const std::byte> bytes);

    std::string path_;
    std::unique_ptr<std::FILE, Close> file_;
    std::size_t words_;
    std::uint64_t rows_ = 0, bytes_ = 0;
    std::vector<std::byte> planes_, packed_;
};

/// `subject` stands in the errors. `most_bytes`: of the rows in memory. Errors: recording.no_recording (other bytes), recording.version,
/// recording.damaged (where it was cut off, too), recording.too_large.
[[nodiscard]] Result<KeptRows> parse_scope_file(std::span<const std::byte> bytes, const std::string& subject,
                                                std::size_t most_bytes = std::size_t{2} << 30);
/// Errors: recording.open too.
[[nodiscard]] Result<KeptRows> read_scope_file(const std::string& path);

struct ScopeFileInfo {
    ScopeHead head;
    std::uint64_t rows = 0, bytes = 0;
};
/// The head and how many rows there are, without the rows themselves. Errors: as read_scope_file().
[[nodiscard]] Result<ScopeFileInfo> look_at_scope_file(const std::string& path);

}  // namespace taktwerk::runtime
