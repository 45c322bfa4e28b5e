#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "runtime/recording_file/recording_file.hpp"
#include "runtime/recording_file/recording_format.hpp"
#include "runtime/recording_file/recording_head_bytes.hpp"

namespace taktwerk::runtime {

using namespace recording_format;

namespace {
constexpr std::uint64_t end_block_bytes = block_head + end_bytes;
}

std::string part_path(const std::string& first, std::size_t number) {
    if (number <= 1) return first;
    const auto slash = first.find_last_of('/');
    const auto name_at = slash == std::string::npos ? 0 : slash + 1;
    const auto point = first.find_last_of('.');
    const bool has_ending = point != std::string::npos && point > name_at;
    const auto stem = has_ending ? first.substr(0, point) : first;
    return fmt::format("{}.{}{}", stem, number, has_ending ? first.substr(point) : "");
}

RecordingWriter::File::~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

Error RecordingWriter::failure(int number) const {
    return Error{"recording.write", part_path(path_, part_), fmt::format("cannot write the recording: {}", std::strerror(number)),
                 "Check the folder and the space left on the disk; what was written before can be replayed"};
}

// Past the file's last whole block nothing may stay: it would be taken for the beginning of another one.
Result<void> RecordingWriter::put(std::span<const std::byte> bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const auto got = ::pwrite(file_.descriptor(), bytes.data() + done, bytes.size() - done, static_cast<off_t>(written_ + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) {
            const int why = got < 0 ? errno : ENOSPC;
            [[maybe_unused]] const int cut = ::ftruncate(file_.descriptor(), static_cast<off_t>(written_));
            return failure(why);
        }
        done += static_cast<std::size_t>(got);
    }
    written_ += bytes.size();
    return {};
}

Result<void> RecordingWriter::put_block(std::span<const std::byte> bytes, std::size_t records) {
    std::vector<std::byte> all(block_head + bytes.size());
    const std::span<std::byte> head{all.data(), block_head};
    store_le(head, 0, static_cast<std::uint32_t>(bytes.size()));
    store_le(head, 4, static_cast<std::uint32_t>(records));
    store_le(head, 8, block_sum(head, bytes));
    std::memcpy(all.data() + block_head, bytes.data(), bytes.size());
    return put(all);
}

Result<void> RecordingWriter::put_end(std::uint8_t end, std::uint64_t lost) {
    std::array<std::byte, end_bytes> bytes{};
    bytes[0] = static_cast<std::byte>(end);
    store_le(std::span<std::byte>{bytes}, 1, lost);
    return put_block(bytes, 0);
}

Result<RecordingWriter> RecordingWriter::create(const std::string& path, RecordingInfo info, RecordingRoom room) {
    RecordingWriter writer{path, std::move(info), room};
    if (auto begun = writer.begin_part(); !begun) return std::move(begun).error();
    return writer;
}

Result<void> RecordingWriter::begin_part() {
    ++part_;
    before_ += std::exchange(written_, 0);
    file_ = File{::open(part_path(path_, part_).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
    if (file_.descriptor() < 0) return failure(errno);
    auto info = info_;
    if (room_.part > 0) info.facts.emplace_back(part_fact, std::to_string(part_));
    const auto head = head_bytes(info);
    std::vector<std::byte> all(preamble_bytes + head.size());
    std::memcpy(all.data(), magic.data(), magic.size());
    store_le(std::span{all}, 6, recording_version);
    store_le(std::span{all}, 8, static_cast<std::uint32_t>(head.size()));
    store_le(std::span{all}, 12, crc32(head));
    std::memcpy(all.data() + preamble_bytes, head.data(), head.size());
    return put(all);
}

Result<void> RecordingWriter::write(const PackedBlock& block) {
    const auto more = block_head + block.bytes.size() + end_block_bytes;
    if (room_.all > 0 && bytes() + more > room_.all)
        return Error{"recording.limit", path_, fmt::format("the recording has used up its {} bytes and ends here", room_.all),
                     "What was written can be replayed; give it more room: --record-disk"};
    if (room_.part > 0 && written_ + more > room_.part && part_ < 999'999) {
        if (auto ended = put_end(next_part_goes_on, 0); !ended) return ended;
        if (::fdatasync(file_.descriptor()) != 0) return failure(errno);
        if (auto begun = begin_part(); !begun) return begun;
    }
    return put_block(block.bytes, block.records);
}

Result<void> RecordingWriter::finish(RecordingEnd end, std::uint64_t lost) {
    const auto before = written_;
    if (auto put = put_end(static_cast<std::uint8_t>(end), lost); !put) return put;
    // /dev/null and the like have nothing that could be made to last.
    if (::fdatasync(file_.descriptor()) != 0 && errno != EINVAL) return failure(errno);
    if (end == RecordingEnd::kept) written_ = before;
    return {};
}

Result<void> save_recording(const std::string& path, const RecordingInfo& info, const Recorder& recorder, RecordChannel beat) {
    auto writer = RecordingWriter::create(path, info);
    if (!writer) return std::move(writer).error();
    RecordPacker packer{beat};
    Result<void> done;
    const auto put = [&] {
        if (const auto records = packer.records(); done && records > 0) done = writer->write({packer.take(), records});
    };
    recorder.for_each([&](const RecordView& record) {
        packer.add(record);
        if (packer.full()) put();
    });
    put();
    if (!done) return done;
    return writer->finish(RecordingEnd::whole, recorder.dropped() + recorder.overwritten());
}

}  // namespace taktwerk::runtime
