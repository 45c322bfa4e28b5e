#pragma once
// Recordings as files, written block by block while the machine runs and readable up to the last whole block whenever that ends, in one file or in
// parts. Not real-time safe: a thread of its own drains a Recorder into a RecordPacker and that into a RecordingWriter.
//
// Format, little-endian: "TWREC" 00h, version u16, length of the head u32, CRC-32 of the head u32; the head: number of facts u16, each as
// two texts (u16 length, bytes), number of channels u16, each a text. Then blocks: length u32, number of records u32, CRC-32 u32 of these and the
// bytes, bytes (record_block.hpp). The last block of a file has no records and says how it ends: RecordingEnd u8 (FFh: the next part goes on),
// number of lost records u64. Version 1 was not compressed.

#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/recorder.hpp"
#include "core/result.hpp"
#include "runtime/recording_file/record_block.hpp"
#include "runtime/recording_file/recording.hpp"

namespace taktwerk::runtime {

inline constexpr std::uint16_t recording_version = 2;
/// Fact of each part of a recording in parts, from 1 on.
inline constexpr std::string_view part_fact = "part";

/// The file of part `number`: "cell.twrec", then "cell.2.twrec", "cell.3.twrec".
[[nodiscard]] std::string part_path(const std::string& first, std::size_t number);

struct RecordingRoom {
    std::uint64_t part = 0;  ///< bytes of a file, then the next part begins (one block more at most); 0: one file
    std::uint64_t all = 0;   ///< bytes of all files; 0: as the disk has them
};

/// A block as it comes from RecordPacker::take().
struct PackedBlock {
    std::vector<std::byte> bytes;
    std::size_t records = 0;
};

/// One that was cut off by a full disk is cut back to its last whole block.
class RecordingWriter {
public:
    /// Errors: recording.write (with the file's name and the system's reason).
    [[nodiscard]] static Result<RecordingWriter> create(const std::string& path, RecordingInfo info, RecordingRoom room = {});
    /// Into the file, whole. Errors: recording.write; recording.limit: the room is used up; there is still some for its end.
    Result<void> write(const PackedBlock& block);
    /// The end with the number of records that were lost before they got here. Only behind `kept` may more follow: it takes the place of this end.
    Result<void> finish(RecordingEnd end, std::uint64_t lost);
    [[nodiscard]] std::uint64_t bytes() const noexcept { return before_ + written_; }
    [[nodiscard]] std::size_t parts() const noexcept { return part_; }

private:
    class File {
    public:
        explicit File(int descriptor) noexcept : descriptor_(descriptor) {}
        File(File&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
        File& operator=(File&& other) noexcept {
            std::swap(descriptor_, other.descriptor_);
            return *this;
        }
        ~File();
        [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

    private:
        int descriptor_;
    };
    RecordingWriter(std::string path, RecordingInfo info, RecordingRoom room)
        : path_(std::move(path)), info_(std::move(info)), room_(room) {}
    [[nodiscard]] Result<void> begin_part();
    [[nodiscard]] Result<void> put(std::span<const std::byte> bytes);
    [[nodiscard]] Result<void> put_block(std::span<const std::byte> bytes, std::size_t records);
    [[nodiscard]] Result<void> put_end(std::uint8_t end, std::uint64_t lost);
    [[nodiscard]] Error failure(int number) const;

    std::string path_;
    RecordingInfo info_;
    RecordingRoom room_;
    File file_{-1};
    std::size_t part_ = 0;
    std::uint64_t before_ = 0, written_ = 0;  ///< bytes of the parts before, of this one
};

/// Reads one, in parts or not, block by block: a run of hours need not fit into memory. Everything is checked before the first record is given.
class RecordingReader final : public RecordSource {
public:
    /// `path`: of its first part. Errors: recording.read, recording.not_a_recording, recording.version, recording.corrupt (with the byte offset),
    /// recording.not_the_first (of a later part).
    [[nodiscard]] static Result<std::unique_ptr<RecordingReader>> open(const std::string& path);
    /// A file in memory, as one of no parts.
    [[nodiscard]] static Result<std::unique_ptr<RecordingReader>> of(std::vector<std::byte> file, const std::string& name);

    [[nodiscard]] const RecordingInfo& info() const noexcept override { return info_; }
    [[nodiscard]] std::uint64_t lost() const noexcept override { return lost_; }
    [[nodiscard]] RecordingEnd end() const noexcept override { return end_; }
    [[nodiscard]] Result<std::optional<RecordView>> next() override;
    /// Of all its parts.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }
    [[nodiscard]] std::uint64_t records() const noexcept { return records_; }
    [[nodiscard]] std::size_t parts() const noexcept { return parts_.size(); }

private:
    /// Reads at an offset; false: the file does not have it any more.
    using Reads = std::function<bool(std::uint64_t, std::span<std::byte>)>;
    struct Part {
        std::string name;
        std::uint64_t size = 0;
        Reads read;
    };
    struct Place {
        std::size_t part;
        std::uint64_t offset;
        std::size_t length, records;
    };
    RecordingReader() = default;
    [[nodiscard]] static Result<Part> open_part(const std::string& path);
    [[nodiscard]] Result<void> take_part(Part part);
    [[nodiscard]] Result<RecordingInfo> read_head(const Part& part, std::uint64_t& blocks_at) const;
    [[nodiscard]] Result<void> scan(std::size_t part, std::uint64_t at);

    std::vector<Part> parts_;
    RecordingInfo info_;
    std::vector<Place> blocks_;
    std::uint64_t lost_ = 0, bytes_ = 0, records_ = 0;
    RecordingEnd end_ = RecordingEnd::torn;
    bool goes_on_ = false;  ///< by its end, the last part is not the last
    std::size_t next_block_ = 0, next_record_ = 0;
    std::vector<std::byte> packed_;
    UnpackedBlock block_;
};

/// All that is in the recorder now (which nobody writes meanwhile), and its losses, as one file. `beat`: as RecordPacker has it.
Result<void> save_recording(const std::string& path, const RecordingInfo& info, const Recorder& recorder, RecordChannel beat);

}  // namespace taktwerk::runtime
