#include "ecat/wire/frame.hpp"

#include <algorithm>

#include "core/bytes.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::size_t frame_header_size = ethernet_header_size + ecat_header_size;
constexpr std::uint16_t length_mask = 0x07FF;  // 11 bits, in the EtherCAT header and in each datagram
constexpr std::uint16_t circulating_bit = 0x4000;
constexpr std::uint16_t more_bit = 0x8000;
constexpr std::uint16_t type_commands = 1;

template <class Byte>
FrameError open(std::span<Byte> frame, std::span<Byte>& datagrams) noexcept {
    if (frame.size() < frame_header_size) return FrameError::too_short;
    // The EtherType is the only big-endian field.
    const auto type = static_cast<std::uint16_t>((static_cast<unsigned>(frame[12]) << 8) | static_cast<unsigned>(frame[13]));
    if (type != ethertype) return FrameError::not_ethercat;
    const auto header = load_le<std::uint16_t>(frame, ethernet_header_size);
    if ((header >> 12) != type_commands) return FrameError::wrong_type;
    const std::size_t length = header & length_mask;
    if (length > frame.size() - frame_header_size) return FrameError::length_beyond_frame;
    datagrams = frame.subspan(frame_header_size, length);
    return FrameError::none;
}

template <class Byte>
std::optional<BasicDatagram<Byte>> take(std::span<Byte>& rest, bool& more, FrameError& error) noexcept {
    if (error != FrameError::none) return std::nullopt;
    if (!more) {
        if (!rest.empty()) error = FrameError::trailing_bytes;
        return std::nullopt;
    }
    if (rest.size() < datagram_overhead) {
        error = FrameError::truncated_datagram;
        return std::nullopt;
    }
    const auto flags = load_le<std::uint16_t>(rest, 6);
    const std::size_t length = flags & length_mask;
    if (length > rest.size() - datagram_overhead) {
        error = FrameError::truncated_datagram;
        return std::nullopt;
    }
    const auto command = static_cast<std::uint8_t>(rest[0]);
    if (command > static_cast<std::uint8_t>(Command::FRMW)) {
        error = FrameError::unknown_command;
        return std::nullopt;
    }
    BasicDatagram<Byte> datagram;
    datagram.command = static_cast<Command>(command);
    datagram.index = static_cast<std::uint8_t>(rest[1]);
    datagram.address.raw = load_le<std::uint32_t>(rest, 2);
    datagram.circulating = (flags & circulating_bit) != 0;
    datagram.more_follow = (flags & more_bit) != 0;
    datagram.irq = load_le<std::uint16_t>(rest, 8);
    datagram.header = rest.first(datagram_header_size);
    datagram.data = rest.subspan(datagram_header_size, length);
    datagram.wkc = rest.subspan(datagram_header_size + length, working_counter_size);
    rest = rest.subspan(datagram_overhead + length);
    more = datagram.more_follow;
    return datagram;
}

}  // namespace

std::string_view text(FrameError error) noexcept {
    switch (error) {
        case FrameError::none: return "no error";
        case FrameError::too_short: return "shorter than the Ethernet and EtherCAT headers";
        case FrameError::not_ethercat: return "EtherType is not 88A4h";
        case FrameError::wrong_type: return "EtherCAT header type is not 1 (commands)";
        case FrameError::length_beyond_frame: return "EtherCAT length field reaches beyond the frame";
        case FrameError::truncated_datagram: return "a datagram reaches beyond the EtherCAT length";
        case FrameError::trailing_bytes: return "bytes follow the last datagram inside the EtherCAT length";
        case FrameError::unknown_command: return "datagram command above 14";
    }
    return "unknown frame error";
}

FrameReader::FrameReader(std::span<const std::byte> ethernet_frame) noexcept {
    error_ = open(ethernet_frame, rest_);
    more_ = !rest_.empty();
}

std::optional<Datagram> FrameReader::next() noexcept { return take(rest_, more_, error_); }

FrameEditor::FrameEditor(std::span<std::byte> ethernet_frame) noexcept {
    error_ = open(ethernet_frame, rest_);
    more_ = !rest_.empty();
}

std::optional<MutableDatagram> FrameEditor::next() noexcept { return take(rest_, more_, error_); }

FrameBuilder::FrameBuilder(std::span<std::byte> buffer, const MacAddress& source, const MacAddress& destination) noexcept
    : buffer_(buffer.first(std::min(buffer.size(), max_frame_size))), used_(frame_header_size) {
    if (buffer_.size() < min_frame_size) {  // cannot hold a valid frame: nothing fits, finish() is empty
        buffer_ = {};
        return;
    }
    for (std::size_t i = 0; i < 6; ++i) {
        buffer_[i] = static_cast<std::byte>(destination[i]);
        buffer_[6 + i] = static_cast<std::byte>(source[i]);
    }
    buffer_[12] = static_cast<std::byte>(ethertype >> 8);
    buffer_[13] = static_cast<std::byte>(ethertype & 0xFF);
}

bool FrameBuilder::fits(std::size_t data_size) const noexcept {
    return data_size <= max_datagram_data && used_ + datagram_overhead + data_size <= buffer_.size();
}

std::span<std::byte> FrameBuilder::add(Command command, std::uint8_t index, Address address, std::size_t data_size) noexcept {
    if (!fits(data_size)) return {};
    if (count_ > 0) {
        const auto flags = load_le<std::uint16_t>(buffer_, last_header_ + 6);
        store_le<std::uint16_t>(buffer_, last_header_ + 6, static_cast<std::uint16_t>(flags | more_bit));
    }
    const auto datagram = buffer_.subspan(used_, datagram_overhead + data_size);
    datagram[0] = static_cast<std::byte>(command);
    datagram[1] = static_cast<std::byte>(index);
    store_le<std::uint32_t>(datagram, 2, address.raw);
    store_le<std::uint16_t>(datagram, 6, static_cast<std::uint16_t>(data_size));
    store_le<std::uint16_t>(datagram, 8, 0);
    std::fill(datagram.begin() + datagram_header_size, datagram.end(), std::byte{0});
    last_header_ = used_;
    used_ += datagram.size();
    ++count_;
    return datagram.subspan(datagram_header_size, data_size);
}

std::span<const std::byte> FrameBuilder::finish() noexcept {
    if (buffer_.empty()) return {};
    const auto length = static_cast<std::uint16_t>(used_ - frame_header_size);
    store_le<std::uint16_t>(buffer_, ethernet_header_size, static_cast<std::uint16_t>(length | (type_commands << 12)));
    const std::size_t size = std::max(used_, min_frame_size);
    std::fill(buffer_.begin() + static_cast<std::ptrdiff_t>(used_), buffer_.begin() + static_cast<std::ptrdiff_t>(size), std::byte{0});
    return buffer_.first(size);
}

}  // namespace taktwerk::ecat
