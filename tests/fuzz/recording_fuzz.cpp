// Any bytes as a recording: an error that names a place, or records of channels that there are. Where the first byte is odd, the rest is the head
// and the records of a file whose lengths and check sums are put right, for chance would not find those; where its second bit is set as well, the
// rest is the inside of a block, before it is compressed. Each record is then read as what its channel makes it in a recording of a machine: what
// can be read is written again as the same bytes, and a file that the machine began with has a name that leads nowhere else.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "core/bytes.hpp"
#include "core/crc32.hpp"
#include "runtime/compression/compression.hpp"
#include "runtime/recording/asked_record.hpp"
#include "runtime/recording/inbox_reader.hpp"
#include "runtime/recording_file/recording_file.hpp"

using namespace taktwerk;
using namespace taktwerk::runtime;

namespace {

using Bytes = std::vector<std::byte>;

template <class T>
void append(Bytes& to, T value) {
    to.resize(to.size() + sizeof(T));
    store_le<T>(std::span{to}, to.size() - sizeof(T), value);
}

void append_block(Bytes& file, std::span<const std::byte> bytes, std::uint32_t records) {
    Bytes head;
    append<std::uint32_t>(head, static_cast<std::uint32_t>(bytes.size()));
    append<std::uint32_t>(head, records);
    file.insert(file.end(), head.begin(), head.end());
    append<std::uint32_t>(file, crc32(bytes, crc32(head)));
    file.insert(file.end(), bytes.begin(), bytes.end());
}

/// [head's length u8][head], then records as [length u8][channel u8][time i64][bytes]; or [head's length u8][head][number of records u16][a block].
Bytes built(std::span<const std::byte> in, bool inside_of_a_block) {
    const auto take = [&in](std::size_t most) {
        const auto part = in.first(std::min(most, in.size()));
        in = in.subspan(part.size());
        return part;
    };
    const auto number = [&take] {
        const auto one = take(1);
        return one.empty() ? std::size_t{0} : std::to_integer<std::size_t>(one[0]);
    };
    Bytes file;
    for (const char c : {'T', 'W', 'R', 'E', 'C', '\0'}) file.push_back(static_cast<std::byte>(c));
    const auto head = take(number());
    append<std::uint16_t>(file, recording_version);
    append<std::uint32_t>(file, static_cast<std::uint32_t>(head.size()));
    append<std::uint32_t>(file, crc32(head));
    file.insert(file.end(), head.begin(), head.end());
    if (inside_of_a_block) {
        const auto records = static_cast<std::uint32_t>(number() | number() << 8);
        Bytes packed;
        compress(in, packed);
        append_block(file, packed, records);
        return file;
    }
    RecordPacker packer{tick_channel};
    while (!in.empty()) {
        const auto length = number(), channel = number();
        Bytes time(8);
        std::ranges::copy(take(8), time.begin());
        packer.add({static_cast<RecordChannel>(channel), Instant{Duration{load_le<std::int64_t>(std::span<const std::byte>{time})}},
                    take(length)});
    }
    if (const auto records = packer.records(); records > 0) append_block(file, packer.take(), static_cast<std::uint32_t>(records));
    const std::array<std::byte, 9> end{};
    append_block(file, end, 0);
    return file;
}

/// `write(recorder, value)` of what was read gives the bytes that were read.
template <class T, class Write>
void same_again(std::span<const std::byte> bytes, const std::optional<T>& value, Write write) {
    if (!value) return;
    Recorder recorder{4096, Recorder::Policy::drop_newest};
    write(recorder, *value);
    std::size_t records = 0;
    recorder.for_each([&](const RecordView& again) {
        ++records;
        if (!std::ranges::equal(again.bytes, bytes)) std::abort();
    });
    if (records != 1) std::abort();
}

void read_as_inbox(std::span<const std::byte> bytes) {
    const Instant at{};
    same_again(bytes, read_tick(bytes), [](Recorder& r, const CycleTick& v) { record_tick(r, v); });
    same_again(bytes, read_command(bytes), [&](Recorder& r, const OperatorCommand& v) { record_command(r, at, v); });
    same_again(bytes, read_level(bytes), [&](Recorder& r, const LevelRecord& v) { record_level(r, at, v.level, v.axis, v.number); });
    same_again(bytes, read_sample(bytes), [&](Recorder& r, const SampleRecord& v) { record_sample(r, at, v.drive, v.sample); });
    same_again(bytes, read_request(bytes),
               [&](Recorder& r, const RequestRecord& v) { record_request(r, at, v.device, v.request, v.state); });
    same_again(bytes, read_word(bytes), [&](Recorder& r, const WordRecord& v) { record_channel(r, at, v.device, v.channel, v.word); });
    same_again(bytes, read_disk(bytes), [&](Recorder& r, const DiskSays& v) { record_disk(r, at, v); });
    same_again(bytes, read_call(bytes), [](Recorder& r, const CallRecord& v) { record_call(r, v.call, v.now, v.index); });
    same_again(bytes, read_wire(bytes), [](Recorder& r, const WireRecord& v) { record_wire(r, v.mac, v.ring); });
    same_again(bytes, read_hook(bytes), [&](Recorder& r, const HookRecord& v) { record_hook(r, at, v.program, v.stop); });
    same_again(bytes, read_slow(bytes), [&](Recorder& r, const SlowRecord& v) { record_slow(r, at, v.task); });
    same_again(bytes, read_task_times(bytes), [&](Recorder& r, const TaskTimesRecord& v) { record_task_times(r, at, v); });
    same_again(bytes, read_faults(bytes), [&](Recorder& r, const FaultsSeen& v) { record_faults(r, at, v); });
    same_again(bytes, read_asked(bytes), [&](Recorder& r, const AskedRecord& v) { record_asked(r, at, v); });
    (void)read_hash(bytes);
    (void)read_link(bytes);
    (void)read_ring(bytes);
    for (std::size_t axis = 0; axis < bytes.size() / setpoint_bytes; ++axis) (void)read_setpoint(bytes, axis);
    if (const auto file = read_start_file(bytes))
        if (file->name.empty() || file->name.front() == '.' || file->name.find('/') != std::string::npos) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::span<const std::byte> in{reinterpret_cast<const std::byte*>(data) + 1, size - 1};
    auto file = (data[0] & 1) != 0 ? built(in, (data[0] & 2) != 0) : Bytes(in.begin(), in.end());
    const auto length = file.size();
    const auto reader = RecordingReader::of(std::move(file), "fuzz.twrec");
    const auto check = [](const Error& error) {
        if (error.code.empty() || error.what.empty()) std::abort();
    };
    if (!reader) return check(reader.error()), 0;
    if ((*reader)->bytes() != length) std::abort();
    for (std::uint64_t records = 0;; ++records) {
        const auto record = (*reader)->next();
        if (!record) return check(record.error()), 0;
        if (!record->has_value()) {
            if (records != (*reader)->records()) std::abort();
            return 0;
        }
        if ((*record)->channel >= (*reader)->info().channels.size()) std::abort();
        read_as_inbox((*record)->bytes);
    }
}
