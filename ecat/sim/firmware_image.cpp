#include "ecat/sim/firmware_image.hpp"

#include <algorithm>
#include <array>

#include "core/bytes.hpp"

namespace taktwerk::ecat::sim {

namespace {

constexpr std::array firmware_magic{std::byte{'T'}, std::byte{'W'}, std::byte{'F'}, std::byte{'W'}};
constexpr std::size_t vendor_at = 4, product_at = 8, revision_at = 12, length_at = 16, crc_at = 20, version_at = 24, version_size = 8;

std::uint32_t crc_of(std::span<const std::byte> bytes, std::uint32_t crc) noexcept {
    for (const std::byte byte : bytes) {
        crc ^= static_cast<std::uint32_t>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? (crc >> 1) ^ 0xEDB88320u : crc >> 1;
    }
    return crc;
}

std::uint32_t checksum_of(std::span<const std::byte> image) noexcept {
    return ~crc_of(image.subspan(version_at), crc_of(image.first(crc_at), 0xFFFFFFFFu));
}

}  // namespace

std::vector<std::byte> firmware_image(const Identity& identity, std::string_view version, std::size_t body) {
    std::vector<std::byte> image(firmware_header_size + body);
    std::copy(firmware_magic.begin(), firmware_magic.end(), image.begin());
    store_le(std::span{image}, vendor_at, identity.vendor);
    store_le(std::span{image}, product_at, identity.product);
    store_le(std::span{image}, revision_at, identity.revision);
    store_le(std::span{image}, length_at, static_cast<std::uint32_t>(body));
    const auto text = std::as_bytes(std::span{version.data(), std::min(version.size(), version_size)});
    std::copy(text.begin(), text.end(), image.begin() + version_at);
    std::uint32_t state = crc_of(std::span{image}.first(firmware_header_size), 1) | 1u;
    for (std::size_t i = firmware_header_size; i < image.size(); ++i) {
        state = state * 1664525u + 1013904223u;  // Numerical Recipes
        image[i] = static_cast<std::byte>(state >> 24);
    }
    store_le(std::span{image}, crc_at, checksum_of(image));
    return image;
}

std::optional<FirmwareInfo> read_firmware(std::span<const std::byte> bytes) {
    if (bytes.size() < firmware_header_size || !std::equal(firmware_magic.begin(), firmware_magic.end(), bytes.begin()))
        return std::nullopt;
    FirmwareInfo info;
    info.identity = {load_le<std::uint32_t>(bytes, vendor_at), load_le<std::uint32_t>(bytes, product_at),
                     load_le<std::uint32_t>(bytes, revision_at), 0};
    const auto text = bytes.subspan(version_at, version_size);
    info.version.assign(reinterpret_cast<const char*>(text.data()),
                        static_cast<std::size_t>(std::find(text.begin(), text.end(), std::byte{0}) - text.begin()));
    const std::size_t body = load_le<std::uint32_t>(bytes, length_at);
    info.size = firmware_header_size + body;
    info.sound =
        body <= bytes.size() - firmware_header_size && checksum_of(bytes.first(info.size)) == load_le<std::uint32_t>(bytes, crc_at);
    return info;
}

}  // namespace taktwerk::ecat::sim
