// Who may come in: users in a file, sessions, how often somebody may guess, what a browser sends to log in.

#include <sys/stat.h>

#include <algorithm>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hmi_bridge/web/account/login_gate.hpp"
#include "hmi_bridge/web/account/login_request.hpp"
#include "hmi_bridge/web/account/password.hpp"
#include "hmi_bridge/web/account/password_desk.hpp"
#include "hmi_bridge/web/account/sessions.hpp"
#include "hmi_bridge/web/account/users.hpp"

namespace taktwerk::hmi::web {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

// RFC 9106's Argon2id as libsodium writes it: 64 MiB, 2 passes, 1 lane.
TEST(PagePasswords, AreKeptAsArgon2id) {
    const auto hash = hash_password("correct horse");
    ASSERT_TRUE(hash);
    EXPECT_THAT(*hash, ::testing::StartsWith("$argon2id$v=19$m=65536,t=2,p=1$"));
    EXPECT_TRUE(password_matches(*hash, "correct horse"));
    EXPECT_FALSE(password_matches(*hash, "correct horsf"));
    EXPECT_FALSE(password_matches(*hash, ""));
    EXPECT_NE(*hash_password("correct horse"), *hash) << "each has a salt of its own";
    EXPECT_FALSE(hash_password("seven77"));
    EXPECT_FALSE(hash_password(std::string(longest_password + 1, 'x')));
}

// A hash of the file decides how dear a login is: a GiB or a minute is nobody's password.
TEST(PagePasswords, OtherHashesAndDearerOnesAreNone) {
    for (const char* hash : {"", "secret", "$2b$12$abcdefghijklmnopqrstuv", "$argon2i$v=19$m=65536,t=2,p=1$AAAA$BBBB",
                             "$argon2id$v=19$m=4194304,t=2,p=1$AAAA$BBBB", "$argon2id$v=19$m=65536,t=1000000,p=1$AAAA$BBBB",
                             "$argon2id$v=19$m=65536,t=2,p=8$AAAA$BBBB", "$argon2id$v=19$"}) {
        EXPECT_FALSE(is_password_hash(hash)) << hash;
        EXPECT_FALSE(password_matches(hash, "secret")) << hash;
    }
    EXPECT_TRUE(is_password_hash("$argon2id$v=19$m=65536,t=2,p=1$AAAA$BBBB"));
}

const std::string hash_text = "$argon2id$v=19$m=65536,t=2,p=1$AAAA$BBBB";

TEST(PageUsers, AreReadAsTheyWereWritten) {
    Users users;
    ASSERT_TRUE(users.put({"olga", Role::viewer, hash_text}));
    ASSERT_TRUE(users.put({"\xE5\xBC\xA0\xE4\xBC\x9F", Role::admin, hash_text}));
    const auto again = Users::read(users.text(), "file");
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(again->all(), users.all());
}

TEST(PageUsers, WhatIsWrongIsNamedWithItsPlace) {
    const auto one = [](const std::string& inside) { return R"({"users":[{)" + inside + "}]}"; };
    const auto good = R"("name":"a","role":"viewer","password":")" + hash_text + "\"";
    ASSERT_TRUE(Users::read(one(good), "file"));
    const std::pair<std::string, const char*> cases[]{
        {"", "no JSON"},
        {"[]", "the one key"},
        {R"({"users":[],"more":1})", "the one key"},
        {R"({"users":[1]})", "no object"},
        {one(R"("name":"a","role":"root","password":"x")"), "none of viewer"},
        {one(R"("name":"a","password":"x")"), "role is missing"},
        {one(R"("name":7)"), "not a text"},
        {one(R"("name":"a","role":"viewer","password":"secret")"), "no Argon2id hash"},
        {one(R"("name":"a b","role":"viewer","password":")" + hash_text + "\""), "1 to 64 bytes"},
        {one(good + R"(,"shell":"/bin/sh")"), "'shell' is unknown"},
        {one(good + R"(,"role":"admin")"), "stands twice"},
        {R"({"users":[{)" + good + "},{" + good + "}]}", "stands there twice"},
        {R"({"users":[[[[[[]]]]]]})", "levels"},
        {std::string(Users::longest_file + 1, ' '), "longer than"},
    };
    for (const auto& [text, what] : cases) {
        const auto users = Users::read(text, "file");
        ASSERT_FALSE(users) << text;
        EXPECT_EQ(users.error().code, "web.users");
        EXPECT_THAT(users.error().text(), HasSubstr(what)) << text;
    }
}

TEST(PageUsers, AFileThatOthersMayReadIsRefused) {
    const auto path = (std::filesystem::temp_directory_path() / ("taktwerk-users-" + std::to_string(::getpid()))).string();
    Users users;
    ASSERT_TRUE(users.put({"olga", Role::viewer, hash_text}));
    ASSERT_TRUE(users.save(path));
    struct stat state {};
    ASSERT_EQ(::stat(path.c_str(), &state), 0);
    EXPECT_EQ(state.st_mode & 07777, 0640u);
    EXPECT_TRUE(Users::load(path));
    for (const mode_t mode : {0644, 0660, 0642, 0604}) {
        ASSERT_EQ(::chmod(path.c_str(), mode), 0);
        EXPECT_FALSE(Users::load(path)) << std::oct << mode;
    }
    ASSERT_EQ(::chmod(path.c_str(), 0600), 0);
    ASSERT_TRUE(users.save(path));
    ASSERT_EQ(::stat(path.c_str(), &state), 0);
    EXPECT_EQ(state.st_mode & 07777, 0600u) << "as it was";
    std::filesystem::remove(path);
    EXPECT_FALSE(Users::load(path));
    EXPECT_FALSE(users.save("/proc/none/users"));
}

TEST(PageSessions, EndByTimeByHandAndByTheFile) {
    Sessions sessions;
    Users users;
    ASSERT_TRUE(users.put({"anna", Role::operates, hash_text}));
    const auto* anna = users.find("anna");
    const auto token = sessions.open(*anna, Instant{});
    EXPECT_EQ(token.size(), 64u);
    const auto session = sessions.find(token, Instant{1s});
    ASSERT_NE(session, nullptr);
    EXPECT_EQ(session->user, "anna");
    EXPECT_EQ(sessions.find(token.substr(1), Instant{1s}), nullptr);
    EXPECT_EQ(sessions.find("", Instant{1s}), nullptr);
    EXPECT_EQ(sessions.find(token, Instant{1s} + Sessions::idle + 1s), nullptr) << "half an hour without a page";
    EXPECT_TRUE(session->ended);

    const auto busy = sessions.open(*anna, Instant{});
    for (Duration at = 0s; at < Sessions::longest; at += 20min) EXPECT_NE(sessions.find(busy, Instant{at}), nullptr);
    EXPECT_EQ(sessions.find(busy, Instant{Sessions::longest + 1s}), nullptr);

    const auto third = sessions.open(*anna, Instant{});
    ASSERT_TRUE(users.put({"anna", Role::viewer, hash_text}));
    sessions.apply(users);
    EXPECT_EQ(sessions.find(third, Instant{})->role, Role::viewer);
    ASSERT_TRUE(users.put({"anna", Role::viewer, hash_text + "B"}));
    sessions.apply(users);
    EXPECT_EQ(sessions.find(third, Instant{}), nullptr) << "another password";
    const auto fourth = sessions.open(*users.find("anna"), Instant{});
    users.remove("anna");
    sessions.apply(users);
    EXPECT_EQ(sessions.find(fourth, Instant{}), nullptr);
}

TEST(PageSessions, OfTooManyTheOneUnusedTheLongestEnds) {
    Sessions sessions;
    const User anna{"anna", Role::operates, hash_text};
    std::vector<std::string> tokens;
    for (std::size_t i = 0; i < Sessions::most_of_user; ++i) tokens.push_back(sessions.open(anna, Instant{std::chrono::seconds(i)}));
    EXPECT_NE(sessions.find(tokens[0], Instant{100s}), nullptr);
    (void)sessions.open(anna, Instant{101s});
    EXPECT_NE(sessions.find(tokens[0], Instant{102s}), nullptr);
    EXPECT_EQ(sessions.find(tokens[1], Instant{102s}), nullptr);
    for (std::size_t i = 0; i < 2 * Sessions::most; ++i)
        (void)sessions.open({"user" + std::to_string(i), Role::viewer, hash_text}, Instant{200s});
    EXPECT_EQ(sessions.size(), Sessions::most);
}

// Ten at once, then one each 6 s; the numbers are login_gate.hpp's.
TEST(LoginGateRule, GuessingIsSlow) {
    LoginGate gate(1);
    Instant now{100s};
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(gate.ask("anna", "10.0.0.9", now), 0s) << i;
        if (i < 4) gate.failed("nobody", "10.9.9.9");  // somebody else's failures are not his
    }
    EXPECT_GT(gate.ask("anna", "10.0.0.9", now), 0s);
    EXPECT_GT(gate.ask("emil", "10.0.0.9", now), 0s) << "the address has had its tries, whatever name it says";
    int tries = 0;
    for (int second = 0; second < 3600; ++second) tries += gate.ask("anna", "10.0.0.9", now + std::chrono::seconds(second)) == 0s ? 1 : 0;
    EXPECT_LE(tries, 601);
    EXPECT_GE(tries, 590);
}

TEST(LoginGateRule, TheRealUserGetsInWhileSomebodyGuesses) {
    LoginGate gate(1);
    const Instant now{100s};
    ASSERT_EQ(gate.ask("anna", "10.0.0.1", now), 0s);
    gate.succeeded("anna", "10.0.0.1", now);
    for (int i = 0; i < 100; ++i)
        if (gate.ask("anna", "10.0.0.9", now) == 0s) gate.failed("anna", "10.0.0.9");
    EXPECT_EQ(gate.ask("anna", "10.0.0.1", now), 0s) << "where she has been before";
    EXPECT_EQ(gate.ask("anna", "10.0.0.2", now), 0s) << "where nobody has failed";
}

TEST(LoginGateRule, AKnownAddressGuessesNoFaster) {
    LoginGate gate(1);
    const Instant now{100s};
    gate.succeeded("anna", "10.0.0.1", now);
    int tries = 0;
    for (int i = 0; i < 100; ++i) tries += gate.ask("anna", "10.0.0.1", now) == 0s ? 1 : 0;
    EXPECT_EQ(tries, 10);
}

// A computer has its whole network of 64 bits (RFC 4291 section 2.5.1): as many addresses as it likes are one.
TEST(LoginGateRule, AnIpv6NetworkIsOneAddress) {
    LoginGate gate(1);
    const Instant now{100s};
    int tries = 0;
    for (int i = 0; i < 200; ++i) tries += gate.ask("user" + std::to_string(i), "2001:db8:1:2::" + std::to_string(i), now) == 0s ? 1 : 0;
    EXPECT_EQ(tries, 10);
    EXPECT_EQ(gate.ask("anna", "2001:db8:1:3::1", now), 0s) << "another network is another address";
    gate.succeeded("anna", "2001:db8:1:3::1", now);
    EXPECT_TRUE(gate.knows("anna", "2001:db8:1:3:ffff::7"));
    EXPECT_FALSE(gate.knows("anna", "2001:db8:1:4::1"));
    EXPECT_FALSE(gate.knows("emil", "2001:db8:1:3::1"));
}

// A crowd that spends a name's tries, each address its first one, locks nobody out of the computer itself; guessing there is as slow.
TEST(LoginGateRule, AtTheComputerItselfOnlyTheAddressCounts) {
    LoginGate gate(1);
    const Instant now{100s};
    for (int i = 0; i < 100; ++i) (void)gate.ask("adam", "10.0.1." + std::to_string(i), now);
    ASSERT_GT(gate.ask("adam", "10.0.2.1", now), 0s) << "else nothing was spent";
    for (const char* here : {"127.0.0.1", "::1"}) {
        int tries = 0;
        for (int i = 0; i < 100; ++i) tries += gate.ask("adam", here, now) == 0s ? 1 : 0;
        EXPECT_EQ(tries, 10) << here;
    }
}

TEST(PasswordDesk, WhoHasBeenHereBeforeDoesNotWaitForACrowd) {
    const auto hash = *hash_password("correct horse");
    std::mutex mutex;
    std::condition_variable one_more;
    std::vector<std::string> done;
    PasswordDesk desk;
    const auto ask = [&](const std::string& who, PasswordDesk::Turn turn) {
        return desk.ask(hash, "correct horse", turn, [&, who](bool matches) {
            EXPECT_TRUE(matches);
            const std::lock_guard lock(mutex);
            done.push_back(who);
            one_more.notify_one();
        });
    };
    std::size_t strangers = 0;
    while (strangers < 20 && ask("stranger", PasswordDesk::Turn::last)) ++strangers;
    EXPECT_LT(strangers, 20u);
    EXPECT_TRUE(ask("anna", PasswordDesk::Turn::before_strangers));
    EXPECT_TRUE(ask("emil", PasswordDesk::Turn::before_strangers));
    std::unique_lock lock(mutex);
    ASSERT_TRUE(one_more.wait_for(lock, 60s, [&] { return done.size() == strangers + 2; }));
    const auto place = [&](const char* who) { return std::find(done.begin(), done.end(), who) - done.begin(); };
    EXPECT_LE(place("anna"), 1) << "at most behind the one that was being computed";
    EXPECT_EQ(place("emil"), place("anna") + 1);
}

TEST(LoginRequests, AreOneObjectOfTwoTexts) {
    const auto request = read_login(R"({"user":"anna","password":"p\u00e4ss\"word"})");
    ASSERT_TRUE(request);
    EXPECT_EQ(request->user, "anna");
    EXPECT_EQ(request->password, "p\xC3\xA4ss\"word");
    for (const std::string& body :
         {std::string{}, std::string("{}"), std::string(R"({"user":"a","password":"b","c":1})"),
          std::string(R"({"user":["a"],"password":"b"})"), R"({"user":")" + std::string(65, 'a') + R"(","password":"b"})",
          R"({"user":"a","password":")" + std::string(513, 'b') + "\"}", std::string(LoginRequest::longest + 1, ' ')})
        EXPECT_FALSE(read_login(body)) << body.substr(0, 80);
}

TEST(LoginRequests, OnlyJsonIsJson) {
    for (const char* type : {"application/json", "Application/JSON", "application/json; charset=utf-8", "application/json ;x=y"})
        EXPECT_TRUE(is_json_type(type)) << type;
    for (const char* type : {"", "text/plain", "application/json5", "application/jsonx", "text/plain; application/json",
                             "multipart/form-data", ";application/json"})
        EXPECT_FALSE(is_json_type(type)) << type;
}

TEST(Cookies, TheRightOneIsFound) {
    EXPECT_EQ(cookie_value("taktwerk_8080=abc", "taktwerk_8080"), "abc");
    EXPECT_EQ(cookie_value("a=b; taktwerk_8080=abc; c=d", "taktwerk_8080"), "abc");
    EXPECT_EQ(cookie_value("xtaktwerk_8080=no;taktwerk_8080=yes", "taktwerk_8080"), "yes");
    for (const char* header : {"", ";;;", "taktwerk_8080", "taktwerk_80801=x", "=", "taktwerk_8081=x", " ; taktwerk_8080 =x"})
        EXPECT_EQ(cookie_value(header, "taktwerk_8080"), "") << header;
}

}  // namespace
}  // namespace taktwerk::hmi::web
