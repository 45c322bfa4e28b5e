#include "hmi_bridge/lcm/whole_message.hpp"

#include <algorithm>
#include <array>

#include "hmi_bridge/command_words.hpp"
#include "hmi_bridge/lcm_types/message_reader.hpp"
#include "hmi_bridge/lcm_types/our_types.hpp"

namespace taktwerk::hmi {
namespace {

using taktwerk_lcm::whole_state_v5_t;

// The fields before the first text stand at fixed places: fingerprint, utime, seq, protocol_version, run, publication, check.
constexpr std::size_t protocol_at = 24, run_at = 28, publication_at = 36, check_at = 44, head_size = 52, check_size = 8;

std::uint64_t big_endian(std::span<const std::byte> bytes, std::size_t at, std::size_t size) noexcept {
    std::uint64_t value = 0;
    for (std::size_t i = at; i < at + size; ++i) value = value << 8 | std::to_integer<std::uint64_t>(bytes[i]);
    return value;
}

/// FNV-1a, 64 bits, over `message` with zeros in place of its check. draft-eastlake-fnv, section 2: offset basis and prime.
std::uint64_t check_of(std::span<const std::byte> message) noexcept {
    constexpr std::uint64_t basis = 0xcbf29ce484222325, prime = 0x100000001b3;
    std::uint64_t hash = basis;
    const auto take = [&](std::span<const std::byte> part) {
        for (const auto byte : part) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * prime;
    };
    constexpr std::array<std::byte, check_size> zeros{};
    take(message.first(check_at));
    take(zeros);
    take(message.subspan(head_size));
    return hash;
}

}  // namespace

std::span<const std::byte> write_whole_state(const whole_state_v5_t& state, std::vector<std::byte>& buffer) {
    const auto size = static_cast<std::size_t>(state.getEncodedSize());
    if (buffer.size() < size) buffer.resize(size);
    if (size < head_size || state.encode(buffer.data(), 0, static_cast<int>(size)) != static_cast<int>(size)) return {};
    const auto message = std::span(buffer).first(size);
    auto check = check_of(message);
    for (std::size_t i = 0; i < check_size; ++i, check >>= 8) message[head_size - 1 - i] = static_cast<std::byte>(check);
    return message;
}

std::optional<WholeHead> head_of_whole_state(std::span<const std::byte> message) noexcept {
    if (message.size() < head_size || message.size() > longest_message) return std::nullopt;
    if (fingerprint_of(message) != static_cast<std::uint64_t>(whole_state_v5_t::getHash())) return std::nullopt;
    if (big_endian(message, protocol_at, 4) != static_cast<std::uint64_t>(protocol_version)) return std::nullopt;
    if (big_endian(message, check_at, check_size) != check_of(message)) return std::nullopt;
    return WholeHead{static_cast<std::int64_t>(big_endian(message, run_at, 8)),
                     static_cast<std::int64_t>(big_endian(message, publication_at, 8))};
}

Result<whole_state_v5_t> read_whole_state(std::span<const std::byte> message) {
    static const auto catalog = our_types();
    const auto bad = [](const char* what) {
        return Error{"lcm.bad_message", "whole_state_v5_t", what, "Whoever publishes it has another version of the type, or means harm."};
    };
    const auto* type = catalog.find("taktwerk_lcm.whole_state_v5_t");
    if (type == nullptr) return bad("this program does not know the type");
    // Generated decoders trust counts and lengths: these are held against the bytes first.
    if (auto checked = check_message(catalog, *type, message); !checked) return checked.error();
    if (!head_of_whole_state(message)) return bad("its check is not that of its bytes, or it is of another protocol");
    whole_state_v5_t state{};
    if (state.decode(message.data(), 0, static_cast<int>(message.size())) != static_cast<int>(message.size()))
        return bad("it cannot be decoded");
    return state;
}

}  // namespace taktwerk::hmi
