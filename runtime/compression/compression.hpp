#pragma once
// Bytes made small and back, by zstd: each call by itself, so that what it gave can be read without anything that stood before it. What is made
// large again may be anybody's: its size is the caller's, known before a byte of it is allocated. Not real-time.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace taktwerk::runtime {

/// The longest that so many bytes can become.
[[nodiscard]] std::size_t compressed_bound(std::size_t bytes) noexcept;
/// Appends to `to`. Bytes of a machine's signals get smaller fast, not as small as they could.
void compress(std::span<const std::byte> bytes, std::vector<std::byte>& to);
/// What the packed bytes say of the length they had. They may lie. Nothing: they are no packed bytes.
[[nodiscard]] std::optional<std::size_t> size_before_compression(std::span<const std::byte> packed) noexcept;
/// False: they are damaged, or not of the size of `to`.
[[nodiscard]] bool decompress(std::span<const std::byte> packed, std::span<std::byte> to) noexcept;

}  // namespace taktwerk::runtime
