#pragma once
// A recording for whoever reads it: what stands in its head, and its records one after the other, wherever they come from. Not real-time.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/recorder.hpp"
#include "core/result.hpp"

namespace taktwerk::runtime {

struct RecordingInfo {
    std::vector<std::string> channels;                       ///< RecordChannel is the index
    std::vector<std::pair<std::string, std::string>> facts;  ///< hashes of configuration and programs, binary, start state, ...

    friend bool operator==(const RecordingInfo&, const RecordingInfo&) = default;
};

/// How it ends.
enum class RecordingEnd : std::uint8_t {
    whole,    ///< with the run
    kept,     ///< the run went on: it was kept while the machine ran
    limit,    ///< where the room that it was given was full
    torn,     ///< its end is missing: whoever recorded died, or the disk was full. What is there is sound
    no_part,  ///< it goes on in a part that is not there
};

class RecordSource {
public:
    virtual ~RecordSource() = default;
    [[nodiscard]] virtual const RecordingInfo& info() const noexcept = 0;
    /// Records that were lost before they got there: then nothing behind the first of them is certain.
    [[nodiscard]] virtual std::uint64_t lost() const noexcept = 0;
    [[nodiscard]] virtual RecordingEnd end() const noexcept = 0;
    /// The next one, valid until the next call; nothing: that was all. Errors: recording.read, recording.corrupt.
    [[nodiscard]] virtual Result<std::optional<RecordView>> next() = 0;
};

/// A recording in memory.
struct Recording {
    RecordingInfo info;
    std::uint64_t lost = 0;
    RecordingEnd end = RecordingEnd::torn;

    [[nodiscard]] std::size_t size() const noexcept { return frames.size(); }
    [[nodiscard]] RecordView record(std::size_t index) const noexcept {
        const Frame& frame = frames[index];
        return {frame.channel, frame.time, std::span{bytes}.subspan(frame.offset, frame.length)};
    }
    void add(const RecordView& record) {
        frames.push_back({record.channel, record.time, bytes.size(), record.bytes.size()});
        bytes.insert(bytes.end(), record.bytes.begin(), record.bytes.end());
    }

    struct Frame {
        RecordChannel channel;
        Instant time;
        std::size_t offset, length;
    };
    std::vector<std::byte> bytes;
    std::vector<Frame> frames;  ///< in the order of recording
};

/// Of a recording in memory, which outlives it.
class MemorySource final : public RecordSource {
public:
    explicit MemorySource(const Recording& recording) : recording_(recording) {}
    [[nodiscard]] const RecordingInfo& info() const noexcept override { return recording_.info; }
    [[nodiscard]] std::uint64_t lost() const noexcept override { return recording_.lost; }
    [[nodiscard]] RecordingEnd end() const noexcept override { return recording_.end; }
    [[nodiscard]] Result<std::optional<RecordView>> next() override {
        if (next_ == recording_.size()) return std::optional<RecordView>{};
        return std::optional{recording_.record(next_++)};
    }

private:
    const Recording& recording_;
    std::size_t next_ = 0;
};

}  // namespace taktwerk::runtime
