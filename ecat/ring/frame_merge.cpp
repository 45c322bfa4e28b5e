#include "ecat/ring/frame_merge.hpp"

#include <algorithm>
#include <cstring>

#include "core/bytes.hpp"
#include "ecat/wire/commands.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::size_t first_datagram = ethernet_header_size + ecat_header_size;
constexpr std::uint16_t length_mask = 0x07FF, more_bit = 0x8000;

bool counts_slaves(std::byte command) noexcept { return ecat::counts_slaves(static_cast<Command>(command)); }

std::uint64_t word_at(std::span<const std::byte> bytes, std::size_t at) noexcept {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
}

void merge_data(const FrameCopy& first, const FrameCopy& second, std::span<std::byte> out, std::size_t at, std::size_t end) noexcept {
    for (; at + sizeof(std::uint64_t) <= end; at += sizeof(std::uint64_t)) {
        const std::uint64_t sent = word_at(first.sent, at);
        const std::uint64_t word = sent ^ ((word_at(first.came, at) ^ sent) | (word_at(second.came, at) ^ word_at(second.sent, at)));
        std::memcpy(out.data() + at, &word, sizeof word);
    }
    for (; at < end; ++at) out[at] = first.sent[at] ^ ((first.came[at] ^ first.sent[at]) | (second.came[at] ^ second.sent[at]));
}

}  // namespace

std::optional<std::size_t> DatagramWalk::next() noexcept {
    if (!more_) return std::nullopt;
    at_ = at_ == 0 ? first_datagram : at_ + datagram_overhead + size_;
    if (at_ + datagram_overhead > frame_.size()) return std::nullopt;
    const auto flags = load_le<std::uint16_t>(frame_, at_ + frame_field::length);
    size_ = flags & length_mask;
    more_ = (flags & more_bit) != 0;
    if (at_ + datagram_overhead + size_ > frame_.size()) return std::nullopt;
    return at_;
}

bool same_datagrams(const FrameCopy& copy) noexcept {
    const auto &sent = copy.sent, &came = copy.came;  // clang 14 lets no lambda see a structured binding
    if (came.size() < sent.size() ||
        !std::equal(sent.begin() + ethernet_header_size, sent.begin() + first_datagram, came.begin() + ethernet_header_size))
        return false;
    DatagramWalk walk{sent};
    while (const auto at = walk.next()) {
        const auto same = [&](std::size_t from, std::size_t to) {
            return std::equal(sent.begin() + static_cast<std::ptrdiff_t>(*at + from), sent.begin() + static_cast<std::ptrdiff_t>(*at + to),
                              came.begin() + static_cast<std::ptrdiff_t>(*at + from));
        };
        constexpr std::uint16_t fixed = length_mask | more_bit;  // a slave marks frames that go round
        const bool addressed =
            counts_slaves(sent[*at]) ? same(frame_field::ado, frame_field::length) : same(frame_field::adp, frame_field::length);
        const auto flags = [&](std::span<const std::byte> frame) {
            return load_le<std::uint16_t>(frame, *at + frame_field::length) & fixed;
        };
        if (!same(0, frame_field::adp) || !addressed || flags(sent) != flags(came)) return false;
    }
    return true;
}

void merge(const FrameCopy& first, const FrameCopy& second, std::span<std::byte> out) noexcept {
    out[frame_field::source] |=
        (first.came[frame_field::source] | second.came[frame_field::source]) & std::byte{frame_field::passed_a_slave};
    DatagramWalk walk{first.sent};
    while (const auto at = walk.next()) {
        const auto added = [&](const FrameCopy& copy, std::size_t offset) {
            return load_le<std::uint16_t>(copy.came, offset) - load_le<std::uint16_t>(copy.sent, offset);
        };
        const auto sum = [&](std::size_t offset) {
            store_le(out, offset,
                     static_cast<std::uint16_t>(load_le<std::uint16_t>(first.sent, offset) + added(first, offset) + added(second, offset)));
        };
        if (counts_slaves(first.sent[*at])) sum(*at + frame_field::adp);
        for (std::size_t i = *at + frame_field::irq; i < *at + datagram_header_size; ++i) out[i] = first.came[i] | second.came[i];
        const std::size_t data = *at + datagram_header_size;
        merge_data(first, second, out, data, data + walk.size());
        sum(data + walk.size());
    }
}

std::optional<std::uint16_t> slaves_passed(const FrameCopy& copy) noexcept {
    DatagramWalk walk{copy.sent};
    while (const auto at = walk.next())
        if (counts_slaves(copy.sent[*at]))
            return static_cast<std::uint16_t>(load_le<std::uint16_t>(copy.came, *at + frame_field::adp) -
                                              load_le<std::uint16_t>(copy.sent, *at + frame_field::adp));
    return std::nullopt;
}

}  // namespace taktwerk::ecat
