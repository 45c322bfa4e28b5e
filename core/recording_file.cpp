#include "core/recording_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "core/bytes.hpp"
#include "core/crc32.hpp"

namespace taktwerk {
namespace {

constexpr std::array<char, 6> magic{'T', 'W', 'R', 'E', 'C', '\0'};
constexpr std::size_t preamble_size = 16;
constexpr std::size_t frame_size = 20;
constexpr RecordChannel end_mark = 0xFFFF;

class HeadBuilder {
public:
    void number(std::size_t value) {
        bytes_.resize(bytes_.size() + 2);
        store_le(std::span{bytes_}, bytes_.size() - 2, static_cast<std::uint16_t>(value));
    }
    void text(std::string_view text) {
        const std::size_t length = std::min<std::size_t>(text.size(), 0xFFFF);
        number(length);
        const auto all = std::as_bytes(std::span{text.data(), length});
        bytes_.insert(bytes_.end(), all.begin(), all.end());
    }
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

private:
    std::vector<std::byte> bytes_;
};

/// Reads what HeadBuilder wrote; past the end everything is empty and ok() false.
class HeadReader {
public:
    explicit HeadReader(std::span<const std::byte> bytes) : rest_(bytes) {}
    std::size_t number() {
        if (rest_.size() < 2) return ok_ = false, 0;
        const auto value = load_le<std::uint16_t>(rest_);
        rest_ = rest_.subspan(2);
        return value;
    }
    std::string text() {
        const std::size_t length = number();
        if (rest_.size() < length) return ok_ = false, std::string{};
        std::string out(length, '\0');
        std::transform(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(length), out.begin(),
                       [](std::byte b) { return static_cast<char>(b); });
        rest_ = rest_.subspan(length);
        return out;
    }
    [[nodiscard]] bool ok() const { return ok_; }

private:
    std::span<const std::byte> rest_;
    bool ok_ = true;
};

std::array<std::byte, frame_size> frame_head(const RecordView& record) {
    std::array<std::byte, frame_size> head{};
    store_le(std::span<std::byte>{head}, 0, static_cast<std::uint32_t>(record.bytes.size()));
    store_le(std::span<std::byte>{head}, 4, record.channel);
    store_le(std::span<std::byte>{head}, 8, std::int64_t{record.time.time_since_epoch().count()});
    store_le(std::span<std::byte>{head}, 16, crc32(record.bytes, crc32(std::span{head}.first(16))));
    return head;
}

}  // namespace

Error RecordingWriter::failure(int number) const {
    return Error{"recording.write", path_, fmt::format("cannot write the recording: {}", std::strerror(number)),
                 "Check the folder and the space left on the disk"};
}

Result<void> RecordingWriter::put(std::span<const std::byte> bytes) {
    if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) return failure(errno);
    return {};
}

Result<RecordingWriter> RecordingWriter::create(const std::string& path, const RecordingInfo& info) {
    RecordingWriter writer{path, std::fopen(path.c_str(), "wbe")};
    if (writer.file_ == nullptr) return writer.failure(errno);

    HeadBuilder head;
    head.number(info.facts.size());
    for (const auto& [name, value] : info.facts) {
        head.text(name);
        head.text(value);
    }
    head.number(info.channels.size());
    for (const auto& channel : info.channels) head.text(channel);

    std::array<std::byte, preamble_size> preamble{};
    std::memcpy(preamble.data(), magic.data(), magic.size());
    store_le(std::span<std::byte>{preamble}, 6, recording_version);
    store_le(std::span<std::byte>{preamble}, 8, static_cast<std::uint32_t>(head.bytes().size()));
    store_le(std::span<std::byte>{preamble}, 12, crc32(head.bytes()));
    if (auto done = writer.put(preamble); !done) return std::move(done).error();
    if (auto done = writer.put(head.bytes()); !done) return std::move(done).error();
    return writer;
}

Result<void> RecordingWriter::write(const RecordView& record) {
    if (auto done = put(frame_head(record)); !done) return done;
    return put(record.bytes);
}

Result<void> RecordingWriter::finish(std::uint64_t lost) {
    std::array<std::byte, 8> bytes{};
    store_le(std::span<std::byte>{bytes}, 0, lost);
    if (auto done = write({end_mark, Instant{}, bytes}); !done) return done;
    if (std::fflush(file_.get()) != 0) return failure(errno);
    return {};
}

RecordView Recording::record(std::size_t index) const noexcept {
    const Frame& frame = frames[index];
    return {frame.channel, frame.time, std::span{bytes}.subspan(frame.offset, frame.length)};
}

Result<Recording> parse_recording(std::vector<std::byte> file, const std::string& name) {
    Recording recording;
    recording.bytes = std::move(file);
    const std::span<const std::byte> all{recording.bytes};
    const auto corrupt = [&](std::size_t offset, std::string_view what) {
        return Error{"recording.corrupt", name, fmt::format("{} at byte {}", what, offset),
                     "The file was damaged after it was written; use a backup"};
    };

    if (all.size() < preamble_size || std::memcmp(all.data(), magic.data(), magic.size()) != 0)
        return Error{"recording.not_a_recording", name, "this is not a recording: it does not begin with TWREC", ""};
    if (const auto version = load_le<std::uint16_t>(all, 6); version != recording_version)
        return Error{"recording.version", name,
                     fmt::format("the recording has format {}, this program reads format {}", version, recording_version),
                     "Replay it with the program that recorded it"};
    const std::size_t head_size = load_le<std::uint32_t>(all, 8);
    if (head_size > all.size() - preamble_size) return corrupt(preamble_size, "the head is cut off");
    const auto head = all.subspan(preamble_size, head_size);
    if (crc32(head) != load_le<std::uint32_t>(all, 12)) return corrupt(preamble_size, "wrong checksum of the head");

    HeadReader reader{head};
    for (std::size_t left = reader.number(); left > 0 && reader.ok(); --left) {
        std::string fact = reader.text();
        recording.info.facts.emplace_back(std::move(fact), reader.text());
    }
    for (std::size_t left = reader.number(); left > 0 && reader.ok(); --left) recording.info.channels.push_back(reader.text());
    if (!reader.ok()) return corrupt(preamble_size, "inconsistent head");

    for (std::size_t at = preamble_size + head_size; all.size() - at >= frame_size;) {
        const auto frame = all.subspan(at);
        const std::size_t length = load_le<std::uint32_t>(frame);
        if (length > frame.size() - frame_size) break;  // cut off
        const auto content = frame.subspan(frame_size, length);
        if (crc32(content, crc32(frame.first(16))) != load_le<std::uint32_t>(frame, 16)) return corrupt(at, "wrong checksum of a record");
        const auto channel = load_le<std::uint16_t>(frame, 4);
        if (channel == end_mark) {
            if (length != 8) return corrupt(at, "malformed end mark");
            recording.lost = load_le<std::uint64_t>(content);
            recording.complete = true;
            if (frame.size() != frame_size + length) return corrupt(at + frame_size + length, "bytes after the end mark");
            break;
        }
        if (channel >= recording.info.channels.size()) return corrupt(at, "a record of an unknown channel");
        recording.frames.push_back({channel, Instant{Duration{load_le<std::int64_t>(frame, 8)}}, at + frame_size, length});
        at += frame_size + length;
    }
    return recording;
}

Result<Recording> load_recording(const std::string& path) {
    const auto failure = [&] {
        return Error{"recording.read", path, fmt::format("cannot read the recording: {}", std::strerror(errno)), "Check the path"};
    };
    struct Close {
        void operator()(std::FILE* f) const noexcept { std::fclose(f); }
    };
    const std::unique_ptr<std::FILE, Close> file{std::fopen(path.c_str(), "rbe")};
    if (file == nullptr) return failure();
    std::vector<std::byte> bytes;
    std::array<std::byte, 65536> block;
    while (const std::size_t got = std::fread(block.data(), 1, block.size(), file.get()))
        bytes.insert(bytes.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(got));
    if (std::ferror(file.get()) != 0) return failure();
    return parse_recording(std::move(bytes), path);
}

Result<void> save_recording(const std::string& path, const RecordingInfo& info, const Recorder& recorder) {
    auto writer = RecordingWriter::create(path, info);
    if (!writer) return std::move(writer).error();
    Result<void> done;
    recorder.for_each([&](const RecordView& record) {
        if (done) done = writer->write(record);
    });
    if (!done) return done;
    return writer->finish(recorder.dropped() + recorder.overwritten());
}

}  // namespace taktwerk
