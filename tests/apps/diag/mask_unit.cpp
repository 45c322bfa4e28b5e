// Secrets do not leave the house, and nothing else is taken away.
#include "apps/diag/mask.hpp"

#include <gmock/gmock.h>

namespace taktwerk::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(Mask, ValuesOfSecretKeysAreGoneInEachWayToWriteThem) {
    for (const auto* line : {"password: hunter2", "  mqtt_password: \"hunter2\"", "Password:hunter2", "\"api_token\": \"hunter2\",",
                             "{user: plc, passwd: hunter2, port: 1883}", "psk='hunter2'", "taktwerk x --password hunter2 --json",
                             "client-secret = hunter2", "password_hash: hunter2", "- secret: hunter2", "private_key: hunter2"}) {
        const auto clean = masked(line);
        EXPECT_THAT(clean.text, Not(HasSubstr("hunter2"))) << line;
        EXPECT_THAT(clean.text, HasSubstr(std::string(mask))) << line;
        ASSERT_EQ(clean.where.size(), 1u) << line;
        EXPECT_THAT(clean.where[0], Not(HasSubstr("hunter2")));
    }
}

// Values as people choose them, and keys as other programs write them.
TEST(Mask, ValuesWithBlanksCommasAndSignsAreGoneToTheirEnd) {
    for (const auto* text : {"password: correct horse hunter2",
                             "password: ab,hunter2",
                             "password: [a, hunter2]",
                             "password: !!str hunter2",
                             "password: &p hunter2",
                             "'password': 'hunter2'",
                             "password: 'it''s hunter2'",
                             "password: ,hunter2",
                             "password: }hunter2",
                             "{password: 'a b hunter2', port: 1}",
                             R"(log: "{\"password\":\"hunter2\"}")",
                             "url: mqtt://plc:hun/hunter2@b",
                             "url: mqtt://plc:p@hunter2@b",
                             "password:\n  hunter2\n",
                             "password:\n  - a\n  - hunter2\n",
                             "password:\n- hunter2\n",
                             "password: \"a\n  hunter2\"\n",
                             "private_key: | # comment\n  hunter2\n",
                             "credentials: |\n  hunter2\n",
                             "community: >-\n  hunter2\n",
                             "password_hash: |\n  hunter2\n",
                             "mqttPassword: hunter2",
                             "accessToken: hunter2",
                             "passwords: [hunter2]",
                             "tokens: hunter2",
                             "AWS_SECRET_ACCESS_KEY=hunter2",
                             "secret_key: hunter2",
                             "password2: hunter2"}) {
        const auto clean = masked(text);
        EXPECT_THAT(clean.text, Not(HasSubstr("hunter2"))) << text;
        EXPECT_THAT(clean.where, Not(IsEmpty())) << text;
    }
}

TEST(Mask, WhatIsNoDeeperThanTheKeyIsNotOfItsValue) {
    EXPECT_EQ(masked("- secret: x\n  port: 1\n- name: a\n").text, "- secret: <masked>\n  port: 1\n- name: a\n");
    EXPECT_EQ(masked("password:\nport: 1\n").text, "password:\nport: 1\n");
}

TEST(Mask, WhatStandsBesideItStays) {
    EXPECT_EQ(masked("{user: plc, password: hunter2, port: 1883}").text, "{user: plc, password: <masked>, port: 1883}");
    EXPECT_EQ(masked("a: 1\npassword: \"x y\"  # of the broker\nb: 2\n").text, "a: 1\npassword: \"<masked>\"  # of the broker\nb: 2\n");
    EXPECT_THAT(masked("a: 1\npassword: x\n").where, ElementsAre("line 2: password"));
}

TEST(Mask, AUserInAnAddressLosesThePasswordAlone) {
    const auto clean = masked("url: mqtt://plc:hunter2@broker:1883/x\n");
    EXPECT_EQ(clean.text, "url: mqtt://plc:<masked>@broker:1883/x\n");
    EXPECT_EQ(clean.where.size(), 1u);
    EXPECT_EQ(masked("lcm: udpm://239.255.76.67:7667?ttl=0").text, "lcm: udpm://239.255.76.67:7667?ttl=0");
}

TEST(Mask, TheLinesOfABlockAreMaskedUntilItEnds) {
    EXPECT_EQ(masked("tls:\n  private_key: |\n    AAAA\n\n    BBBB\n  port: 8883\n").text,
              "tls:\n  private_key: |\n    <masked>\n\n    <masked>\n  port: 8883\n");
}

// Also where it stands in a list or a map of one line; what follows is left as it is.
TEST(Mask, AListOrMapOfSecretsIsOneValue) {
    EXPECT_EQ(masked(R"({"password":["one","two"],"name":"cell"})").text, R"({"password":<masked>,"name":"cell"})");
    EXPECT_EQ(masked("a: { x: 1, secrets: { a: one, b: 'tw}o' }, y: 2 }").text, "a: { x: 1, secrets: <masked>, y: 2 }");
}

// RFC 7468: whoever prints a key, its lines look like this.
TEST(Mask, APrivateKeyIsMaskedWhereverItStands) {
    EXPECT_EQ(masked("a\n-----BEGIN EC PRIVATE KEY-----\nAAAA\n-----END EC PRIVATE KEY-----\nb\n").text,
              "a\n<masked>\n<masked>\n<masked>\nb\n");
    EXPECT_EQ(masked("private_key: -----BEGIN PRIVATE KEY-----\nAAAA\n-----END PRIVATE KEY-----\nb: 1\n").text,
              "<masked>\n<masked>\n<masked>\nb: 1\n");
    EXPECT_THAT(masked("-----BEGIN PRIVATE KEY-----\nAAAA\n").where, ElementsAre("line 1: a private key"));
    EXPECT_EQ(masked("-----BEGIN CERTIFICATE-----\nAAAA\n").text, "-----BEGIN CERTIFICATE-----\nAAAA\n") << "is for everybody";
}

TEST(Mask, ShortNamesAndHeadersOfRequestsAreSecretsToo) {
    EXPECT_EQ(masked("Authorization: Bearer hunter2\npwd: hunter2\nmqtt_pass: hunter2\n").text,
              "Authorization: <masked>\npwd: <masked>\nmqtt_pass: <masked>\n");
    for (const auto* text : {"bypass: 1", "passes: 3", "compass: north", "passed: 7"}) EXPECT_EQ(masked(text).text, text);
}

TEST(Mask, OrdinaryTextIsLeftAsItIs) {
    for (const auto* text :
         {"", "\n", "name: cell\naxes:\n  - name: x\n", "# no passwords here", "the password of the drive is asked for", "monkey: 7",
          "keyboard: de", "tokenizer: on", "secretary: Li", "LCM knows no users and no passwords", "0x1C12: 1", "a\r\nb\r\n"}) {
        const auto clean = masked(text);
        EXPECT_EQ(clean.text, text);
        EXPECT_THAT(clean.where, IsEmpty()) << text;
    }
}

TEST(Mask, TwiceIsAsOnce) {
    const auto once = masked("password: hunter2\nurl: http://a:b@c\n");
    const auto twice = masked(once.text);
    EXPECT_EQ(twice.text, once.text);
}

TEST(Mask, ALineThatIsLongerThanAnybodyReadsIsMaskedWhole) {
    const std::string filler(10'000, 'x');
    EXPECT_EQ(masked(filler + " password: hunter2").text, std::string(mask));
    EXPECT_EQ(masked("password: hunter2 " + filler).text, std::string(mask));
    EXPECT_EQ(masked(filler).text, filler);
}

}  // namespace
}  // namespace taktwerk::apps
