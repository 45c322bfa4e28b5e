#include "hmi_bridge/web/account/password.hpp"

#include <sodium.h>

#include <array>
#include <charconv>

#include <fmt/format.h>

namespace taktwerk::hmi::web {
namespace {

constexpr unsigned long long operations = crypto_pwhash_argon2id_OPSLIMIT_INTERACTIVE;
constexpr std::size_t memory = crypto_pwhash_argon2id_MEMLIMIT_INTERACTIVE;

bool ready() {
    static const bool done = sodium_init() >= 0;
    return done;
}

std::string hexadecimal(const unsigned char* bytes, std::size_t count) {
    std::string text(2 * count + 1, '\0');
    sodium_bin2hex(text.data(), text.size(), bytes, count);
    text.pop_back();
    return text;
}

/// The number behind `name`, up to the next comma or dollar; 0 where none stands.
std::uint64_t cost(std::string_view hash, std::string_view name) {
    const auto at = hash.find(name);
    std::uint64_t value = 0;
    if (at != std::string_view::npos) std::from_chars(hash.data() + at + name.size(), hash.data() + hash.size(), value);
    return value;
}

}  // namespace

Result<std::string> hash_password(std::string_view password) {
    if (password.size() < shortest_password || password.size() > longest_password)
        return Error{"web.password", "password", fmt::format("it has {} bytes", password.size()),
                     fmt::format("Use {} to {}.", shortest_password, longest_password)};
    std::array<char, crypto_pwhash_STRBYTES> hash{};
    if (!ready() || crypto_pwhash_argon2id_str(hash.data(), password.data(), password.size(), operations, memory) != 0)
        return Error{"web.password", "password", "its hash cannot be computed", "See that 64 MiB of memory are free."};
    return std::string(hash.data());
}

bool password_matches(const std::string& hash, std::string_view password) {
    return ready() && password.size() <= longest_password && is_password_hash(hash) &&
           crypto_pwhash_argon2id_str_verify(hash.c_str(), password.data(), password.size()) == 0;
}

bool is_password_hash(std::string_view hash) {
    if (!hash.starts_with("$argon2id$v=19$") || hash.size() >= crypto_pwhash_STRBYTES || hash.find('\0') != std::string_view::npos)
        return false;
    const auto kibibytes = cost(hash, "m="), passes = cost(hash, ",t="), lanes = cost(hash, ",p=");
    return kibibytes >= 8 && kibibytes <= 8 * memory / 1024 && passes >= 1 && passes <= 8 * operations && lanes == 1;
}

std::string random_token() {
    std::array<unsigned char, 32> bytes{};
    if (!ready()) return {};
    randombytes_buf(bytes.data(), bytes.size());
    return hexadecimal(bytes.data(), bytes.size());
}

std::uint64_t random_seed() {
    std::uint64_t seed = 0;
    if (ready()) randombytes_buf(&seed, sizeof seed);
    return seed;
}

std::string token_digest(std::string_view token) {
    std::array<unsigned char, crypto_generichash_BYTES> digest{};
    if (!ready()) return {};
    crypto_generichash(digest.data(), digest.size(), reinterpret_cast<const unsigned char*>(token.data()), token.size(), nullptr, 0);
    return hexadecimal(digest.data(), digest.size());
}

}  // namespace taktwerk::hmi::web
