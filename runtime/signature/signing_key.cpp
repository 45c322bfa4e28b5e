#include "runtime/signature/signing_key.hpp"

#include <sodium.h>

#include <algorithm>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "runtime/signature/sha256.hpp"

namespace taktwerk::runtime {

namespace {

using Byte = unsigned char;

// RFC 8410, sections 4 and 7: what stands in front of the 32 bytes of the key. The algorithm's number is 1.3.101.112.
constexpr std::array<Byte, 12> before_public{0x30, 0x2A, 0x30, 0x05, 0x06, 0x03, 0x2B, 0x65, 0x70, 0x03, 0x21, 0x00};
constexpr std::array<Byte, 16> before_secret{0x30, 0x2E, 0x02, 0x01, 0x00, 0x30, 0x05, 0x06,
                                             0x03, 0x2B, 0x65, 0x70, 0x04, 0x22, 0x04, 0x20};
constexpr std::string_view public_label = "PUBLIC KEY", secret_label = "PRIVATE KEY";
constexpr std::size_t key_size = 32;
constexpr std::size_t longest_pem = 4096;  ///< bytes; a key has about 120

/// Random numbers, and the library's choice of the processor's fastest code.
bool ready() {
    static const bool done = sodium_init() >= 0;
    return done;
}

std::string pem_of(std::string_view label, std::span<const Byte> head, std::span<const Byte> key) {
    std::vector<Byte> bytes(head.begin(), head.end());
    bytes.insert(bytes.end(), key.begin(), key.end());
    std::string text(sodium_base64_encoded_len(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
    sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), sodium_base64_VARIANT_ORIGINAL);
    text.pop_back();
    sodium_memzero(bytes.data(), bytes.size());
    return fmt::format("-----BEGIN {0}-----\n{1}\n-----END {0}-----\n", label, text);
}

/// The key that stands behind `head`; nothing where the text is no PEM of that label and kind.
std::optional<std::array<Byte, key_size>> key_in(std::string_view text, std::string_view label, std::span<const Byte> head) {
    const auto begin = fmt::format("-----BEGIN {}-----", label), end = fmt::format("-----END {}-----", label);
    const auto first = text.find(begin);
    if (text.size() > longest_pem || first == std::string_view::npos) return std::nullopt;
    const auto body = text.substr(first + begin.size());
    const auto last = body.find(end);
    if (last == std::string_view::npos) return std::nullopt;
    std::array<Byte, 128> bytes{};
    std::size_t count = 0;
    const bool read =
        sodium_base642bin(bytes.data(), bytes.size(), body.data(), last, " \t\r\n", &count, nullptr, sodium_base64_VARIANT_ORIGINAL) == 0;
    std::optional<std::array<Byte, key_size>> key;
    if (read && count == head.size() + key_size && std::equal(head.begin(), head.end(), bytes.begin())) {
        key.emplace();
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(head.size()), key_size, key->begin());
    }
    sodium_memzero(bytes.data(), bytes.size());
    return key;
}

const Byte* bytes_of(std::string_view text) { return reinterpret_cast<const Byte*>(text.data()); }

struct KeyPair {
    std::array<Byte, crypto_sign_PUBLICKEYBYTES> open{};
    std::array<Byte, crypto_sign_SECRETKEYBYTES> secret{};
    explicit KeyPair(const Byte* seed) {
        (void)ready();
        crypto_sign_seed_keypair(open.data(), secret.data(), seed);
    }
    ~KeyPair() { sodium_memzero(secret.data(), secret.size()); }
    KeyPair(const KeyPair&) = delete;
    KeyPair& operator=(const KeyPair&) = delete;
};

}  // namespace

Result<PublicKey> PublicKey::of_pem(std::string_view text, const std::string& file) {
    if (const auto key = key_in(text, public_label, before_public)) return PublicKey(*key);
    return Error{"key.not_public", file,
                 text.find(secret_label) != std::string_view::npos ? "it holds a secret key, which is nobody's but its owner's"
                                                                   : "it is no public Ed25519 key",
                 "put the file with the ending .pub there that `taktwerk bundle keygen` has made"};
}

std::string PublicKey::pem() const { return pem_of(public_label, before_public, bytes_); }

bool PublicKey::has_signed(std::string_view text, std::string_view signature) const {
    return ready() && signature.size() == signature_size &&
           crypto_sign_verify_detached(bytes_of(signature), bytes_of(text), text.size(), bytes_.data()) == 0;
}

std::string PublicKey::fingerprint() const {
    return hexadecimal(sha256_of({reinterpret_cast<const char*>(bytes_.data()), bytes_.size()})).substr(0, 16);
}

Result<SecretKey> SecretKey::make() {
    if (!ready()) return Error{"key.random", "key", "the system gives no random numbers", "see that /dev/urandom is there"};
    Seed seed{};
    randombytes_buf(seed.data(), seed.size());
    SecretKey key(seed);
    sodium_memzero(seed.data(), seed.size());
    return key;
}

Result<SecretKey> SecretKey::of_pem(std::string_view text, const std::string& file) {
    if (auto seed = key_in(text, secret_label, before_secret)) {
        SecretKey key(*seed);
        sodium_memzero(seed->data(), seed->size());
        return key;
    }
    return Error{"key.not_secret", file,
                 text.find(public_label) != std::string_view::npos  ? "it holds a public key, and signing takes the secret one"
                 : text.find("ENCRYPTED") != std::string_view::npos ? "it is encrypted"
                                                                    : "it is no secret Ed25519 key",
                 "name the file with the ending .key that `taktwerk bundle keygen` has made"};
}

SecretKey::~SecretKey() { sodium_memzero(seed_.data(), seed_.size()); }
SecretKey::SecretKey(SecretKey&& other) noexcept : seed_(other.seed_) { sodium_memzero(other.seed_.data(), other.seed_.size()); }

std::string SecretKey::pem() const { return pem_of(secret_label, before_secret, seed_); }

PublicKey SecretKey::public_half() const { return PublicKey(KeyPair(seed_.data()).open); }

std::string SecretKey::sign(std::string_view text) const {
    const KeyPair keys(seed_.data());
    std::string signature(signature_size, '\0');
    crypto_sign_detached(reinterpret_cast<Byte*>(signature.data()), nullptr, bytes_of(text), text.size(), keys.secret.data());
    return signature;
}

}  // namespace taktwerk::runtime
