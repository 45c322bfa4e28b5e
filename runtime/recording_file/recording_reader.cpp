#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "runtime/recording_file/recording_file.hpp"
#include "runtime/recording_file/recording_format.hpp"
#include "runtime/recording_file/recording_head_bytes.hpp"

namespace taktwerk::runtime {

using namespace recording_format;

namespace {

struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};

Error corrupt(const std::string& name, std::uint64_t offset, std::string_view what) {
    return Error{"recording.corrupt", name, fmt::format("{} at byte {}", what, offset),
                 "The file was damaged after it was written; use a backup"};
}

/// Its last bytes are those that a run writes at its end.
template <class Part>
bool has_end(const Part& part) {
    std::array<std::byte, block_head + end_bytes> last{};
    if (part.size < last.size() || !part.read(part.size - last.size(), last)) return false;
    const std::span<const std::byte> bytes{last};
    return load_le<std::uint32_t>(bytes) == end_bytes && load_le<std::uint32_t>(bytes, 4) == 0 &&
           load_le<std::uint32_t>(bytes, 8) == block_sum(bytes, bytes.subspan(block_head));
}

/// 0: it says nothing of parts.
std::size_t part_of(const RecordingInfo& info) {
    for (const auto& [name, value] : info.facts)
        if (std::size_t number = 0;
            name == part_fact && std::from_chars(value.data(), value.data() + value.size(), number).ec == std::errc{})
            return number;
    return 0;
}

RecordingInfo without_part(RecordingInfo info) {
    std::erase_if(info.facts, [](const auto& fact) { return fact.first == part_fact; });
    return info;
}

}  // namespace

Result<RecordingReader::Part> RecordingReader::open_part(const std::string& path) {
    const std::shared_ptr<std::FILE> file{std::fopen(path.c_str(), "rbe"), [](std::FILE* f) { f != nullptr ? Close{}(f) : void(); }};
    const auto failure = [&] {
        return Error{"recording.read", path, fmt::format("cannot read the recording: {}", std::strerror(errno)), "Check the path"};
    };
    if (file == nullptr || std::fseek(file.get(), 0, SEEK_END) != 0) return failure();
    const auto size = std::ftell(file.get());
    // A folder opens, and says that it is as long as can be.
    if (size < 0 || size == std::numeric_limits<long>::max()) return failure();
    return Part{path, static_cast<std::uint64_t>(size), [file](std::uint64_t at, std::span<std::byte> to) {
                    return std::fseek(file.get(), static_cast<long>(at), SEEK_SET) == 0 &&
                           std::fread(to.data(), 1, to.size(), file.get()) == to.size();
                }};
}

Result<RecordingInfo> RecordingReader::read_head(const Part& part, std::uint64_t& blocks_at) const {
    std::array<std::byte, preamble_bytes> preamble{};
    if (part.size < preamble.size() || !part.read(0, preamble) || std::memcmp(preamble.data(), magic.data(), magic.size()) != 0)
        return Error{"recording.not_a_recording", part.name, "this is not a recording: it does not begin with TWREC", ""};
    const std::span<const std::byte> start{preamble};
    if (const auto version = load_le<std::uint16_t>(start, 6); version != recording_version)
        return Error{"recording.version", part.name,
                     fmt::format("the recording has format {}{}, this program reads format {}", version,
                                 version == 1 ? " (not compressed)" : "", recording_version),
                     "Replay it with the taktwerk that recorded it; its version stands in the file's first lines"};
    const std::uint64_t length = load_le<std::uint32_t>(start, 8);
    if (length > part.size - preamble.size()) return corrupt(part.name, preamble.size(), "the head is cut off");
    std::vector<std::byte> head(length);
    if (!part.read(preamble.size(), head) || crc32(head) != load_le<std::uint32_t>(start, 12))
        return corrupt(part.name, preamble.size(), "wrong checksum of the head");
    auto info = read_head_bytes(head);
    if (!info) return corrupt(part.name, preamble.size(), "inconsistent head");
    blocks_at = preamble.size() + length;
    return *std::move(info);
}

Result<void> RecordingReader::scan(std::size_t index, std::uint64_t at) {
    const auto& part = parts_[index];
    end_ = RecordingEnd::torn;
    goes_on_ = false;
    std::array<std::byte, block_head> head{};
    while (part.size - at >= block_head) {
        if (!part.read(at, head)) return corrupt(part.name, at, "nothing can be read");
        const std::span<const std::byte> start{head};
        const std::uint64_t length = load_le<std::uint32_t>(start), records = load_le<std::uint32_t>(start, 4);
        if (length > most_packed_bytes) return corrupt(part.name, at, "a block that is too long");
        if (length > part.size - at - block_head) {  // cut off, unless the end is there after all
            if (has_end(part)) return corrupt(part.name, at, "wrong length of a block");
            return {};
        }
        packed_.resize(length);
        if (!part.read(at + block_head, packed_) || block_sum(start, packed_) != load_le<std::uint32_t>(start, 8))
            return corrupt(part.name, at, "wrong checksum of a block");
        const auto behind = at + block_head + length;
        if (records == 0) {
            const auto end = length == end_bytes ? std::to_integer<std::uint8_t>(packed_[0]) : std::uint8_t{0xFE};
            goes_on_ = end == next_part_goes_on;
            if (!goes_on_ && end > static_cast<std::uint8_t>(RecordingEnd::limit)) return corrupt(part.name, at, "malformed end");
            if (behind != part.size) return corrupt(part.name, behind, "bytes behind the end");
            end_ = goes_on_ ? RecordingEnd::no_part : static_cast<RecordingEnd>(end);
            lost_ += load_le<std::uint64_t>(std::span<const std::byte>{packed_}, 1);
            return {};
        }
        blocks_.push_back({index, at + block_head, length, records});
        records_ += records;
        at = behind;
    }
    return {};
}

Result<void> RecordingReader::take_part(Part part) {
    std::uint64_t blocks_at = 0;
    auto info = read_head(part, blocks_at);
    if (!info) return std::move(info).error();
    const auto number = part_of(*info);
    const bool first = parts_.empty();
    if (first && number > 1)
        return Error{"recording.not_the_first", part.name,
                     fmt::format("this is part {} of a recording, and its records go on from part 1", number),
                     "Give the first part: the name without the number; the others are found beside it"};
    if (!first && (number != parts_.size() + 1 || without_part(*info) != without_part(info_))) return {};  // of another recording
    if (first) info_ = std::move(info).value();
    bytes_ += part.size;
    parts_.push_back(std::move(part));
    return scan(parts_.size() - 1, blocks_at);
}

Result<std::unique_ptr<RecordingReader>> RecordingReader::open(const std::string& path) {
    auto part = open_part(path);
    if (!part) return std::move(part).error();
    std::unique_ptr<RecordingReader> reader{new RecordingReader};
    if (auto taken = reader->take_part(std::move(part).value()); !taken) return std::move(taken).error();
    while (reader->goes_on_) {
        const auto before = reader->parts_.size();
        auto next = open_part(part_path(path, before + 1));
        if (!next) break;
        if (auto taken = reader->take_part(std::move(next).value()); !taken) return std::move(taken).error();
        if (reader->parts_.size() == before) break;
    }
    return reader;
}

Result<std::unique_ptr<RecordingReader>> RecordingReader::of(std::vector<std::byte> file, const std::string& name) {
    const auto shared = std::make_shared<const std::vector<std::byte>>(std::move(file));
    Part part{name, shared->size(), [shared](std::uint64_t at, std::span<std::byte> to) {
                  if (at > shared->size() || to.size() > shared->size() - at) return false;
                  std::copy_n(shared->begin() + static_cast<std::ptrdiff_t>(at), to.size(), to.begin());
                  return true;
              }};
    std::unique_ptr<RecordingReader> reader{new RecordingReader};
    if (auto taken = reader->take_part(std::move(part)); !taken) return std::move(taken).error();
    return reader;
}

Result<std::optional<RecordView>> RecordingReader::next() {
    while (next_record_ == block_.size()) {
        if (next_block_ == blocks_.size()) return std::optional<RecordView>{};
        const auto& place = blocks_[next_block_++];
        const auto& part = parts_[place.part];
        packed_.resize(place.length);
        next_record_ = 0;
        if (!part.read(place.offset, packed_))
            return Error{"recording.read", part.name, "the file changed while it was read", "Read it again"};
        if (!block_.unpack(packed_, place.records, info_.channels.size())) return corrupt(part.name, place.offset, "malformed block");
    }
    return std::optional{block_.record(next_record_++)};
}

}  // namespace taktwerk::runtime
