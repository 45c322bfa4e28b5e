#include "runtime/recording_file/record_block.hpp"

#include <algorithm>
#include <limits>

#include "core/bytes.hpp"
#include "runtime/compression/compression.hpp"

namespace taktwerk::runtime {

namespace {

constexpr std::size_t worth_a_block = std::size_t{1} << 20;
constexpr std::size_t most_records = 60'000, most_classes = 4096;
constexpr std::uint16_t places_told_apart = 32;  ///< of records of one kind in one cycle
constexpr std::size_t class_head = 10, time_bytes = 8;

/// Columns of the differences between the rows.
void put_columns(std::span<const std::byte> rows, std::size_t length, std::byte* to) {
    const auto count = length == 0 ? 0 : rows.size() / length;
    for (std::size_t column = 0; column < length; ++column) {
        auto before = std::uint8_t{0};
        for (std::size_t row = 0; row < count; ++row) {
            const auto value = std::to_integer<std::uint8_t>(rows[row * length + column]);
            *to++ = static_cast<std::byte>(value - before);
            before = value;
        }
    }
}

void put_times(std::span<const std::int64_t> times, std::byte* to) {
    std::uint64_t before = 0;
    for (std::size_t row = 0; row < times.size(); ++row) {
        const auto time = static_cast<std::uint64_t>(times[row]);
        const auto step = time - before;
        before = time;
        for (std::size_t b = 0; b < time_bytes; ++b) to[b * times.size() + row] = static_cast<std::byte>(step >> 8 * b & 0xFF);
    }
}

}  // namespace

void RecordPacker::add(const RecordView& record) {
    if (record.channel == beat_) in_this_cycle_.clear();
    auto& place = in_this_cycle_[{record.channel, record.bytes.size()}];
    const auto found = class_of_.try_emplace({record.channel, record.bytes.size(), place}, static_cast<std::uint16_t>(classes_.size()));
    if (place + 1 < places_told_apart) ++place;
    if (found.second) classes_.push_back({record.channel, static_cast<std::uint32_t>(record.bytes.size()), {}, {}});
    const auto index = found.first->second;
    auto& of = classes_[index];
    of.times.push_back(record.time.time_since_epoch().count());
    of.rows.insert(of.rows.end(), record.bytes.begin(), record.bytes.end());
    order_.push_back(index);
    bytes_ += record.bytes.size() + time_bytes + 2;
}

bool RecordPacker::full() const noexcept {
    return bytes_ >= worth_a_block || order_.size() >= most_records || classes_.size() >= most_classes;
}

std::vector<std::byte> RecordPacker::take() {
    plain_.resize(2 + classes_.size() * class_head + bytes_);
    const std::span<std::byte> all{plain_};
    std::size_t at = 0;
    const auto put = [&](auto value) {
        store_le(all, at, value);
        at += sizeof(value);
    };
    put(static_cast<std::uint16_t>(classes_.size()));
    for (const auto& of : classes_) {
        put(of.channel);
        put(of.length);
        put(static_cast<std::uint32_t>(of.times.size()));
    }
    for (const auto index : order_) put(static_cast<std::uint8_t>(index & 0xFF));
    for (const auto index : order_) put(static_cast<std::uint8_t>(index >> 8));
    for (const auto& of : classes_) {
        put_times(of.times, plain_.data() + at);
        at += of.times.size() * time_bytes;
        put_columns(of.rows, of.length, plain_.data() + at);
        at += of.rows.size();
    }
    std::vector<std::byte> packed;
    compress(std::span{plain_}.first(at), packed);
    packed.shrink_to_fit();
    in_this_cycle_.clear();
    class_of_.clear();
    classes_.clear();
    order_.clear();
    bytes_ = 0;
    return packed;
}

bool UnpackedBlock::unpack(std::span<const std::byte> packed, std::size_t records, std::size_t channels) {
    records_.clear();
    const auto size = size_before_compression(packed);
    // Each record takes ten bytes at least: what claims more of them than that lies.
    if (!size || *size > most_block_bytes || *size < 2 || records > *size / (time_bytes + 2)) return false;
    plain_.resize(*size);
    if (!decompress(packed, plain_)) return false;
    const std::span<const std::byte> all{plain_};
    const std::size_t classes = load_le<std::uint16_t>(all);
    if (classes > (all.size() - 2) / class_head) return false;
    struct Class {
        RecordChannel channel;
        std::size_t length, count, columns, rows, next;
    };
    std::vector<Class> of(classes);
    std::size_t at = 2 + classes * class_head, of_all = 0, row_bytes = 0;
    if (all.size() - at < 2 * records) return false;
    const auto order = all.subspan(at, 2 * records);
    at += 2 * records;
    for (std::size_t c = 0; c < classes; ++c) {
        const auto head = all.subspan(2 + c * class_head, class_head);
        auto& one = of[c];
        one = {load_le<std::uint16_t>(head), load_le<std::uint32_t>(head, 2), load_le<std::uint32_t>(head, 6), at, row_bytes, 0};
        if (one.channel >= channels || one.count == 0 || one.count > records) return false;
        if (one.length + time_bytes > (all.size() - at) / one.count) return false;
        at += one.count * (one.length + time_bytes);
        of_all += one.count;
        row_bytes += one.count * one.length;
    }
    if (at != all.size() || of_all != records) return false;

    bytes_.resize(row_bytes);
    std::vector<std::int64_t> times(records);
    std::size_t first = 0;
    for (auto& one : of) {
        std::uint64_t time = 0;
        for (std::size_t row = 0; row < one.count; ++row) {
            std::uint64_t step = 0;
            for (std::size_t b = 0; b < time_bytes; ++b)
                step |= std::to_integer<std::uint64_t>(all[one.columns + b * one.count + row]) << 8 * b;
            time += step;
            times[first + row] = static_cast<std::int64_t>(time);
        }
        const auto columns = all.subspan(one.columns + one.count * time_bytes, one.count * one.length);
        for (std::size_t column = 0; column < one.length; ++column) {
            auto value = std::uint8_t{0};
            for (std::size_t row = 0; row < one.count; ++row) {
                value = static_cast<std::uint8_t>(value + std::to_integer<std::uint8_t>(columns[column * one.count + row]));
                bytes_[one.rows + row * one.length + column] = static_cast<std::byte>(value);
            }
        }
        one.columns = first;  // of its times, from here on
        first += one.count;
    }
    records_.reserve(records);
    for (std::size_t i = 0; i < records; ++i) {
        const auto index = std::to_integer<std::size_t>(order[i]) | std::to_integer<std::size_t>(order[records + i]) << 8;
        if (index >= classes || of[index].next == of[index].count) return records_.clear(), false;
        auto& one = of[index];
        records_.push_back({one.channel, times[one.columns + one.next], one.rows + one.next * one.length, one.length});
        ++one.next;
    }
    return true;
}

RecordView UnpackedBlock::record(std::size_t index) const noexcept {
    const auto& place = records_[index];
    return {place.channel, Instant{Duration{place.time}}, std::span{bytes_}.subspan(place.offset, place.length)};
}

}  // namespace taktwerk::runtime
