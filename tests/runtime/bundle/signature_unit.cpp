// Sums and signatures, by the examples of the standards that define them.

#include "runtime/signature/signing_key.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/signature/sha256.hpp"

namespace taktwerk::runtime {
namespace {

using ::testing::HasSubstr;

std::string bytes_of(std::string_view digits) {
    std::string out;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        out += static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
    return out;
}

// FIPS 180-2, appendix B: "abc", the two-block message, a million times "a".
TEST(Sha256, IsThatOfTheStandard) {
    EXPECT_EQ(hexadecimal(sha256_of("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(hexadecimal(sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    Sha256 million;
    const std::string part(1000, 'a');
    for (int i = 0; i < 1000; ++i) million.add(std::as_bytes(std::span(part.data(), part.size())));
    EXPECT_EQ(hexadecimal(million.finish()), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// RFC 8410, 10.1 and 10.3: the two halves of one key.
constexpr const char* rfc_secret =
    "-----BEGIN PRIVATE KEY-----\nMC4CAQAwBQYDK2VwBCIEINTuctv5E1hK1bbY8fdp+K06/nwoy/HU++CXqI9EdVhC\n-----END PRIVATE KEY-----\n";
constexpr const char* rfc_public =
    "-----BEGIN PUBLIC KEY-----\nMCowBQYDK2VwAyEAGb9ECWmEzf6FQbrBZ9w7lshQhqowtrbLDFw4rXAxZuE=\n-----END PUBLIC KEY-----\n";

TEST(SigningKey, IsTheFileThatTheStandardShows) {
    const auto secret = SecretKey::of_pem(rfc_secret, "a.key");
    ASSERT_TRUE(secret) << secret.error().text();
    EXPECT_EQ(secret->public_half().pem(), rfc_public);
    EXPECT_EQ(secret->pem(), rfc_secret);
    const auto open = PublicKey::of_pem(rfc_public, "a.pub");
    ASSERT_TRUE(open) << open.error().text();
    EXPECT_EQ(*open, secret->public_half());
}

// RFC 8032, 7.1, TEST 2: the secret key in the envelope of RFC 8410, the message 72h.
TEST(SigningKey, SignsAsTheStandardDoes) {
    // base64 of 302e020100300506032b657004220420 and 4ccd089b28ff96da9db6c346ec114e0f5b8a319f35aba624da8cf6ed4fb8a6fb
    const auto key = SecretKey::of_pem(
        "-----BEGIN PRIVATE KEY-----\nMC4CAQAwBQYDK2VwBCIEIEzNCJso/5banbbDRuwRTg9bijGfNaumJNqM9u1PuKb7\n-----END PRIVATE KEY-----",
        "a.key");
    ASSERT_TRUE(key) << key.error().text();
    const auto signature = key->sign("\x72");
    EXPECT_EQ(signature, bytes_of("92a009a9f0d4cab8720e820b5f642540a2b27b5416503f8fb3762223ebdb69da"
                                  "085ac1e43e15996e458f3613d0f11d8c387b2eaeb4302aeeb00d291612bb0c00"));
    EXPECT_TRUE(key->public_half().has_signed("\x72", signature));
}

TEST(SigningKey, WhatWasChangedIsNotSigned) {
    const auto key = SecretKey::make(), other = SecretKey::make();
    ASSERT_TRUE(key && other);
    const std::string text = "what is said";
    const auto signature = key->sign(text);
    ASSERT_TRUE(key->public_half().has_signed(text, signature));
    EXPECT_FALSE(other->public_half().has_signed(text, signature));
    EXPECT_FALSE(key->public_half().has_signed("what is Said", signature));
    for (std::size_t i = 0; i < signature.size(); ++i) {
        auto changed = signature;
        changed[i] = static_cast<char>(changed[i] ^ 0x10);
        EXPECT_FALSE(key->public_half().has_signed(text, changed)) << i;
    }
    for (const std::size_t size : {0, 1, 63}) EXPECT_FALSE(key->public_half().has_signed(text, signature.substr(0, size)));
    EXPECT_FALSE(key->public_half().has_signed(text, signature + '\0'));
}

TEST(SigningKey, ANewOneComesBackFromItsFileAndIsNoOther) {
    const auto key = SecretKey::make(), other = SecretKey::make();
    ASSERT_TRUE(key && other);
    EXPECT_NE(key->pem(), other->pem());
    const auto again = SecretKey::of_pem(key->pem(), "a.key");
    ASSERT_TRUE(again);
    EXPECT_EQ(again->public_half(), key->public_half());
    EXPECT_EQ(key->public_half().fingerprint().size(), 16u);
    EXPECT_NE(key->public_half().fingerprint(), other->public_half().fingerprint());
}

TEST(SigningKey, TheOtherHalfOrSomethingElseIsRefusedByName) {
    const auto as_public = PublicKey::of_pem(rfc_secret, "a.key");
    ASSERT_FALSE(as_public);
    EXPECT_EQ(as_public.error().code, "key.not_public");
    EXPECT_THAT(as_public.error().text(), HasSubstr("a.key: it holds a secret key"));
    const auto as_secret = SecretKey::of_pem(rfc_public, "a.pub");
    ASSERT_FALSE(as_secret);
    EXPECT_THAT(as_secret.error().text(), HasSubstr("it holds a public key"));
    const std::string whole = rfc_public;
    for (std::size_t cut = 0; cut + 2 < whole.size(); cut += 7) EXPECT_FALSE(PublicKey::of_pem(whole.substr(0, cut), "cut")) << cut;
    // X25519 (1.3.101.110) has keys of the same size.
    EXPECT_FALSE(PublicKey::of_pem(
        "-----BEGIN PUBLIC KEY-----\nMCowBQYDK2VuAyEAGb9ECWmEzf6FQbrBZ9w7lshQhqowtrbLDFw4rXAxZuE=\n-----END PUBLIC KEY-----\n", "x"));
}

}  // namespace
}  // namespace taktwerk::runtime
