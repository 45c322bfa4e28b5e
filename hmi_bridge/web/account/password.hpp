#pragma once
// Passwords and tokens, by libsodium: Argon2id and the kernel's random numbers. Nothing here is invented. Any thread; not real-time.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::hmi::web {

constexpr std::size_t longest_password = 512;  ///< bytes
constexpr std::size_t shortest_password = 8;   ///< of one that is set

/// "$argon2id$v=19$m=65536,t=2,p=1$...": crypto_pwhash_str with OPSLIMIT_INTERACTIVE and MEMLIMIT_INTERACTIVE, 64 MiB and some 0.1 s.
/// Errors: web.password (too short, too long, no memory).
[[nodiscard]] Result<std::string> hash_password(std::string_view password);
/// Takes as long whether it matches or not. False for a hash that is none.
[[nodiscard]] bool password_matches(const std::string& hash, std::string_view password);
/// That it is one of Argon2id, and not dearer than this file's own eight times over: a file must not make a login take minutes.
[[nodiscard]] bool is_password_hash(std::string_view hash);

/// 256 random bits in hexadecimal.
[[nodiscard]] std::string random_token();
/// Of the same numbers.
[[nodiscard]] std::uint64_t random_seed();
/// What is kept of a token: looking it up then tells nothing by its time.
[[nodiscard]] std::string token_digest(std::string_view token);

}  // namespace taktwerk::hmi::web
