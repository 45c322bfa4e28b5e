#pragma once
// Recordings as files. Not real-time safe: a thread of its own drains a Recorder into a RecordingWriter.
//
// Format, little-endian: "TWREC" 00h, version u16, length of the head u32, CRC-32 of the head u32; the head: number of facts u16, each as
// two texts (u16 length, bytes), number of channels u16, each a text. Then records: length u32, channel u16, 0 u16, time i64 (ns),
// CRC-32 u32 of these and the bytes, bytes. The last record has channel FFFFh and holds the number of lost records u64.

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/recorder.hpp"
#include "core/result.hpp"

namespace taktwerk {

inline constexpr std::uint16_t recording_version = 1;

struct RecordingInfo {
    std::vector<std::string> channels;                       ///< RecordChannel is the index
    std::vector<std::pair<std::string, std::string>> facts;  ///< hashes of configuration and programs, binary, start state, ...

    friend bool operator==(const RecordingInfo&, const RecordingInfo&) = default;
};

/// Writes a recording record by record, so that one whose process died is readable up to its last record.
/// Errors of all members: recording.write (with the file's name and the system's reason).
class RecordingWriter {
public:
    [[nodiscard]] static Result<RecordingWriter> create(const std::string& path, const RecordingInfo& info);
    Result<void> write(const RecordView& record);
    /// Writes the end mark with the number of records that were lost before they got here. Nothing may follow.
    Result<void> finish(std::uint64_t lost);

private:
    struct Close {
        void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    };
    RecordingWriter(std::string path, std::FILE* file) : path_(std::move(path)), file_(file) {}
    Result<void> put(std::span<const std::byte> bytes);
    [[nodiscard]] Error failure(int number) const;

    std::string path_;
    std::unique_ptr<std::FILE, Close> file_;
};

/// A recording in memory.
struct Recording {
    RecordingInfo info;
    std::uint64_t lost = 0;
    bool complete = false;  ///< false: the end is missing (the recording process died); what is there is sound

    [[nodiscard]] std::size_t size() const noexcept { return frames.size(); }
    [[nodiscard]] RecordView record(std::size_t index) const noexcept;

    struct Frame {
        RecordChannel channel;
        Instant time;
        std::size_t offset, length;
    };
    std::vector<std::byte> bytes;  ///< the file
    std::vector<Frame> frames;     ///< in the order of recording
};

/// Errors: recording.not_a_recording, recording.version, recording.corrupt (with the byte offset).
[[nodiscard]] Result<Recording> parse_recording(std::vector<std::byte> file, const std::string& name);

/// As parse_recording; recording.read when the file cannot be read.
[[nodiscard]] Result<Recording> load_recording(const std::string& path);

/// All that is in the recorder now (which nobody writes meanwhile), and its losses, as one file.
Result<void> save_recording(const std::string& path, const RecordingInfo& info, const Recorder& recorder);

}  // namespace taktwerk
