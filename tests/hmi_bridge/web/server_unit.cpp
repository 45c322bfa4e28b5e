// The page's server over real connections of loopback, before a machine that is one socket: who gets in, who may what, what flows while something else waits.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/hmi_bridge/web/served_site.hpp"

namespace taktwerk::hmi::web {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(ServedSite, AddressesOfOthersNeedUsers) {
    ServerOptions options;
    options.address = "0.0.0.0";
    options.port = 0;
    const auto refused = WebServer::open(options, *SiteFiles::load((folder_ / "page").string()));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, "web.no_users");
    options.users = users_file();
    EXPECT_TRUE(WebServer::open(options, *SiteFiles::load((folder_ / "page").string())));
    EXPECT_TRUE(Users{}.save(options.users));
    const auto nobody = WebServer::open(options, *SiteFiles::load((folder_ / "page").string()));
    ASSERT_FALSE(nobody);
    EXPECT_EQ(nobody.error().code, "web.no_users");
}

TEST_F(ServedSite, FilesCarryTheRulesOfTheBrowser) {
    serve();
    const auto page = http_request(port, "GET /");
    EXPECT_EQ(page.status, 200);
    EXPECT_EQ(page.header("Content-Security-Policy"),
              "default-src 'self'; img-src 'self' blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'self'; object-src 'none'");
    EXPECT_EQ(page.header("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(page.header("X-Frame-Options"), "DENY");
    EXPECT_EQ(http_request(port, "GET /etc/passwd").status, 404);
    EXPECT_EQ(http_request(port, "GET /../users.json").status, 404);
    EXPECT_EQ(http_request(port, "DELETE /").status, 405);
    EXPECT_EQ(http_request(port, "POST /", own_origin()).status, 405);
    EXPECT_EQ(http_request(port, "GET /", {}, {}, "evil.example").status, 403);
    EXPECT_EQ(http_request(port, "GET /", "X-Long: " + std::string(9000, 'a') + "\r\n").status, 431);
    EXPECT_EQ(http_request(port, "POST /api/login", own_origin(), std::string(5000, 'a')).status, 413);
}

TEST_F(ServedSite, ForeignPagesGetNoWebSocket) {
    serve();
    const auto host = "127.0.0.1:" + std::to_string(port);
    PageClient page;
    EXPECT_FALSE(page.open_as(port, host, "http://evil.example"));
    EXPECT_EQ(page.status(), 403);
    EXPECT_FALSE(page.open_as(port, "evil.example", "http://evil.example"));
    EXPECT_EQ(page.status(), 403);
    EXPECT_FALSE(page.open_as(port, host, "null"));
    EXPECT_TRUE(page.open_as(port, host, "http://" + host));
}

TEST_F(ServedSite, WithoutUsersEverybodyIsTheOneRoleAndSeesTheMachine) {
    ServerOptions options;
    options.role = Role::operates;
    serve(options);
    PageClient page;
    ASSERT_TRUE(page.open(port));
    const auto hello = page.next("hello");
    EXPECT_EQ(hello["role"], "operator");
    EXPECT_EQ(hello["user"], "");
    EXPECT_EQ(hello["login"], false);
    const auto state = page.next("state");
    EXPECT_EQ(state["machine"], "demo");
    EXPECT_EQ(state["state"]["machine"], "demo");
    EXPECT_LT(state["age_ms"], 500);
    EXPECT_EQ(log_in("anna", "anna-secret").status, 404);
}

TEST_F(ServedSite, WhoHasNotLoggedInSeesNothingAndCommandsNothing) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    PageClient page;
    ASSERT_TRUE(page.open(port));
    const auto hello = page.next("hello");
    EXPECT_EQ(hello["role"], "");
    EXPECT_EQ(hello["login"], true);
    EXPECT_THAT(hello["may"], IsEmpty());
    EXPECT_THAT(hello["machines"], IsEmpty());
    EXPECT_TRUE(hello["layout"].is_null());
    for (const auto& rule : command_rules) {
        const auto answer = page.ask({{"cmd", rule.command}});
        EXPECT_EQ(answer["error"]["code"], "web.login") << rule.command;
    }
    page.say({{"type", "watch"}, {"machine", "demo"}});
    EXPECT_EQ(page.next("error")["error"]["code"], "web.login");
    EXPECT_TRUE(page.next("state", 300ms).is_null());
    EXPECT_THAT(machine.asked(), IsEmpty());
}

TEST_F(ServedSite, ALoginOpensASessionAndALogoutEndsItAtOpenPages) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    EXPECT_EQ(log_in("anna", "wrong-secret").status, 401);
    const auto unknown = log_in("nobody", "wrong-secret"), wrong = log_in("anna", "another-wrong");
    EXPECT_EQ(unknown.status, wrong.status);
    EXPECT_EQ(unknown.body, wrong.body);
    const auto good = log_in("anna", "anna-secret");
    ASSERT_EQ(good.status, 200) << good.body;
    EXPECT_THAT(good.header("Set-Cookie"), HasSubstr("; Path=/; HttpOnly; SameSite=Strict"));
    EXPECT_THAT(good.header("Set-Cookie"), ::testing::Not(HasSubstr("Secure")));
    const auto cookie = "Cookie: other=1; " + good.header("Set-Cookie").substr(0, good.header("Set-Cookie").find(';')) + "\r\n";

    PageClient page;
    ASSERT_TRUE(page.open(port, cookie));
    const auto hello = page.next("hello");
    EXPECT_EQ(hello["user"], "anna");
    EXPECT_EQ(hello["role"], "operator");
    EXPECT_FALSE(page.next("state").is_null());
    EXPECT_EQ(page.ask({{"cmd", "mode"}, {"mode", "manual"}})["ok"], true);
    EXPECT_EQ(page.ask({{"cmd", "set_parameter"}})["error"]["code"], "web.role");

    EXPECT_EQ(http_request(port, "POST /api/logout", own_origin() + "Content-Type: application/json\r\n" + cookie, "{}").status, 200);
    const auto out = page.next("hello");
    EXPECT_EQ(out["role"], "");
    EXPECT_EQ(page.ask({{"cmd", "mode"}, {"mode", "manual"}})["error"]["code"], "web.login");
    PageClient again;
    ASSERT_TRUE(again.open(port, cookie));
    EXPECT_EQ(again.next("hello")["role"], "");
}

TEST_F(ServedSite, ALoginComesFromTheOwnPageAloneAndAsJson) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    const auto body = R"({"user":"anna","password":"anna-secret"})";
    const std::string json = "Content-Type: application/json\r\n";
    EXPECT_EQ(http_request(port, "POST /api/login", json, body).status, 403);
    EXPECT_EQ(http_request(port, "POST /api/login", "Origin: http://evil.example\r\n" + json, body).status, 403);
    EXPECT_EQ(http_request(port, "POST /api/login", own_origin() + "Content-Type: text/plain\r\n", body).status, 415);
    EXPECT_EQ(http_request(port, "POST /api/login", own_origin() + "Content-Type: application/x-www-form-urlencoded\r\n", body).status,
              415);
    for (const char* bad : {"{}", "[]", "x", R"({"user":"anna"})", R"({"user":1,"password":"x"})",
                            R"({"user":"a","user":"b","password":"x"})", R"({"user":{"a":[[[[1]]]]},"password":"x"})"})
        EXPECT_EQ(http_request(port, "POST /api/login", own_origin() + json, bad).status, 400) << bad;
    EXPECT_EQ(http_request(port, "GET /api/login").status, 404);
}

TEST_F(ServedSite, AnotherRoleAndARemovedUserTakeEffectAtOpenPages) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    PageClient page;
    ASSERT_TRUE(page.open(port, cookie_of("anna")));
    EXPECT_EQ(page.next("hello")["role"], "operator");

    auto users = *Users::load(options.users);
    auto anna = *users.find("anna");
    anna.role = Role::viewer;
    ASSERT_TRUE(users.put(anna));
    ASSERT_TRUE(users.save(options.users));
    const auto is = [](const char* role) {
        return [role](const PageJson& one) { return one.value("type", "") == "hello" && one["role"] == role; };
    };
    EXPECT_FALSE(page.next(is("viewer"), 2s).is_null());
    EXPECT_EQ(page.ask({{"cmd", "mode"}, {"mode", "manual"}})["error"]["code"], "web.role");

    users.remove("anna");
    ASSERT_TRUE(users.save(options.users));
    EXPECT_FALSE(page.next(is(""), 2s).is_null());
    EXPECT_EQ(page.ask({{"cmd", "stop"}})["error"]["code"], "web.login");
}

TEST_F(ServedSite, WhoIsThrownOutLetsGoWhatHeHeld) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    PageClient page;
    ASSERT_TRUE(page.open(port, cookie_of("anna")));
    ASSERT_TRUE(shows_machine(page));
    EXPECT_EQ(page.ask({{"cmd", "jog"}, {"axis", "x"}, {"velocity", 5}, {"press", true}})["ok"], true);
    EXPECT_EQ(machine.connections(), 2u) << "the server's and the page's own";
    auto users = *Users::load(options.users);
    users.remove("anna");
    ASSERT_TRUE(users.save(options.users));
    for (int tries = 0; tries < 200 && machine.connections() > 1; ++tries) ::usleep(10'000);
    EXPECT_EQ(machine.connections(), 1u) << "the machine ends what a closed connection jogged";
}

// What an engineer has forced or set goes with his rights: as a viewer he could not even take it back.
TEST_F(ServedSite, WhoMayLessThanBeforeLetsGoWhatHeHeld) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    PageClient page;
    ASSERT_TRUE(page.open(port, cookie_of("emil")));
    ASSERT_TRUE(shows_machine(page));
    EXPECT_EQ(page.ask({{"cmd", "force"}, {"input", "a"}, {"value", 1}})["ok"], true);
    ASSERT_EQ(machine.connections(), 2u);
    auto users = *Users::load(options.users);
    const auto becomes = [&](Role role) {
        auto emil = *users.find("emil");
        emil.role = role;
        ASSERT_TRUE(users.put(emil));
        ASSERT_TRUE(users.save(options.users));
        EXPECT_FALSE(
            page.next([&](const PageJson& one) { return one.value("type", "") == "hello" && one["role"] == word(role); }, 2s).is_null());
    };
    becomes(Role::admin);
    EXPECT_EQ(page.ask({{"cmd", "force"}, {"input", "b"}, {"value", 1}})["ok"], true);
    EXPECT_EQ(machine.asked("force").at(0).connection, machine.asked("force").at(1).connection) << "who may more keeps what he holds";
    becomes(Role::operates);
    for (int tries = 0; tries < 200 && machine.connections() > 1; ++tries) ::usleep(10'000);
    EXPECT_EQ(machine.connections(), 1u);
    EXPECT_EQ(page.ask({{"cmd", "mode"}, {"mode", "manual"}})["ok"], true) << "and he goes on with what he may";
}

// RFC 6455 section 7.1.1 leaves the connection to the server to close; who keeps it open as well holds nothing by that.
TEST_F(ServedSite, WhoSaysGoodbyeHoldsNothingAnyMore) {
    serve();
    PageClient page;
    ASSERT_TRUE(page.open(port));
    ASSERT_TRUE(shows_machine(page));
    EXPECT_EQ(page.ask({{"cmd", "force"}, {"input", "a"}, {"value", 1}})["ok"], true);
    ASSERT_EQ(machine.connections(), 2u);
    const auto at = PageClock::now();
    ASSERT_TRUE(page.say_bytes(PageClient::frame(0x88, "\x03\xe8")));
    while (machine.connections() > 1 && PageClock::now() - at < 5s) ::usleep(5'000);
    EXPECT_LT(PageClock::now() - at, 1500ms) << "Beast gives up after 2 s";
}

// The numbers are login_gate.hpp's: ten at once; the real user, who has logged in from here before, gets in all the same.
TEST_F(ServedSite, GuessingIsRefusedAfterTenTries) {
    ServerOptions options;
    options.users = users_file();
    options.proxies = {"127.0.0.1"};
    serve(options);
    const auto from = [](const std::string& address) { return "X-Forwarded-For: " + address + "\r\n"; };
    ASSERT_EQ(log_in("anna", "anna-secret", from("10.0.0.1")).status, 200);
    int refused = 0;
    for (int tries = 0; tries < 14; ++tries)
        refused += log_in("anna", "guess-" + std::to_string(tries), from("10.0.0.66")).status == 429 ? 1 : 0;
    EXPECT_GE(refused, 4);
    EXPECT_GE(std::stoi(log_in("anna", "guess", from("10.0.0.66")).header("Retry-After")), 1);
    EXPECT_EQ(log_in("anna", "anna-secret", from("10.0.0.1")).status, 200) << "from where she always is";
    EXPECT_EQ(log_in("anna", "anna-secret", from("10.0.0.2")).status, 200) << "and from a place where nobody has failed";
}

TEST_F(ServedSite, ValuesFlowWhileSomebodyLogsIn) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    PageClient page;
    ASSERT_TRUE(page.open(port, cookie_of("olga")));
    ASSERT_TRUE(shows_machine(page));
    std::atomic<bool> done{false};
    std::thread others([&] {
        for (int i = 0; i < 6; ++i) (void)log_in("emil", "not-this-one", "X-Forwarded-For: 10.0.0." + std::to_string(i) + "\r\n");
        done = true;
    });
    auto worst = 0ms;
    for (auto before = PageClock::now(); !done;) {
        if (page.next("state", 1s).is_null()) break;
        const auto at = PageClock::now();
        worst = std::max(worst, std::chrono::duration_cast<std::chrono::milliseconds>(at - before));
        before = at;
    }
    others.join();
    EXPECT_LT(worst, 500ms) << "older values are grey at a page";
}

TEST_F(ServedSite, CookiesAreSecureBehindATrustedProxyAlone) {
    ServerOptions options;
    options.users = users_file();
    options.names = {"hmi.example"};
    serve(options);
    const std::string headers =
        "Origin: https://hmi.example\r\nContent-Type: application/json\r\nX-Forwarded-Proto: https\r\nX-Forwarded-For: 10.1.1.1\r\n";
    const auto body = R"({"user":"anna","password":"anna-secret"})";
    const auto untrusted = http_request(port, "POST /api/login", headers, body, "hmi.example");
    ASSERT_EQ(untrusted.status, 200);
    EXPECT_THAT(untrusted.header("Set-Cookie"), ::testing::Not(HasSubstr("Secure")));
    EXPECT_THAT(audit().back()["from"].get<std::string>(), HasSubstr("127.0.0.1")) << "what it says of whom it brings is not believed";
    end();
    options.proxies = {"127.0.0.1"};
    serve(options);
    const auto trusted = http_request(port, "POST /api/login", headers, body, "hmi.example");
    EXPECT_THAT(trusted.header("Set-Cookie"), HasSubstr("; Secure"));
    EXPECT_EQ(audit().back()["from"], "10.1.1.1 by 127.0.0.1");
}

// A proxy may put its line behind what a stranger wrote himself (HAProxy does); and what it said of one request is not said of the next.
TEST_F(ServedSite, OfWhomAProxyBringsItsOwnWordCounts) {
    ServerOptions options;
    options.users = users_file();
    options.proxies = {"127.0.0.1"};
    serve(options);
    EXPECT_EQ(log_in("anna", "anna-secret", "X-Forwarded-For: 6.6.6.6\r\nX-Forwarded-For: 7.7.7.7, 10.1.1.1\r\n").status, 200);
    EXPECT_EQ(audit().back()["from"], "10.1.1.1 by 127.0.0.1");
    TcpEnd end;
    ASSERT_TRUE(end.open(port));
    const auto host = "127.0.0.1:" + std::to_string(port);
    const auto body = PageJson{{"user", "anna"}, {"password", "anna-secret"}}.dump();
    end.write("GET / HTTP/1.1\r\nHost: " + host +
              "\r\nX-Forwarded-For: 10.2.2.2\r\nX-Forwarded-Proto: https\r\n\r\nPOST /api/login HTTP/1.1\r\nHost: " + host + "\r\n" +
              own_origin() + "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    std::string got;
    for (const auto until = PageClock::now() + 30s; PageClock::now() < until && end.read(got, 50ms);) {}
    ASSERT_THAT(got, HasSubstr("Set-Cookie"));
    EXPECT_THAT(got, ::testing::Not(HasSubstr("Secure")));
    EXPECT_THAT(audit().back()["from"].get<std::string>(), ::testing::StartsWith("127.0.0.1:"));
}

// RFC 9112 section 3.2: which of two a proxy has looked at, nobody knows.
TEST_F(ServedSite, AHostOrAnOriginThatStandsTwiceIsRefused) {
    serve();
    EXPECT_EQ(http_request(port, "GET /", "Host: evil.example\r\n").status, 400);
    PageClient page;
    EXPECT_FALSE(page.open(port, "Origin: http://evil.example\r\n"));
    EXPECT_EQ(page.status(), 400);
}

TEST_F(ServedSite, EachCommandIsWrittenDownWithWhoFromWhereWhatAndTheAnswer) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    PageClient page;
    ASSERT_TRUE(page.open(port, cookie_of("emil")));
    ASSERT_TRUE(shows_machine(page));
    (void)page.ask({{"cmd", "set_parameter"}, {"parameter", "pick.speed"}, {"value", 12.5}});
    (void)page.ask({{"cmd", "home"}, {"axis", "x"}});
    (void)page.ask({{"cmd", "shutdown"}});
    const auto lines = audit();
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[0]["event"], "login");
    EXPECT_EQ(lines[1]["user"], "emil");
    EXPECT_EQ(lines[1]["role"], "engineer");
    EXPECT_THAT(lines[1]["from"].get<std::string>(), ::testing::StartsWith("127.0.0.1:"));
    EXPECT_EQ(lines[1]["machine"], "demo");
    EXPECT_EQ(lines[1]["request"]["cmd"], "set_parameter");
    EXPECT_EQ(lines[1]["request"]["value"], 12.5);
    EXPECT_EQ(lines[1]["ok"], true);
    EXPECT_EQ(lines[2]["ok"], false);
    EXPECT_EQ(lines[2]["error"]["code"], "command.wrong_mode");
    EXPECT_EQ(lines[3]["error"]["code"], "web.role");
    EXPECT_EQ(machine.asked("shutdown").size(), 0u);
}

// A renewal is not written down, so it has to be one: of a button that the machine has taken as pressed by this page.
TEST_F(ServedSite, AValueThatCallsItselfARenewalIsWrittenDown) {
    serve();
    PageClient page;
    ASSERT_TRUE(page.open(port));
    ASSERT_TRUE(shows_machine(page));
    const auto set = [&](const char* variable, double value, std::optional<bool> press) {
        PageJson message{{"cmd", "set_value"}, {"variable", variable}, {"value", value}};
        if (press) message["press"] = *press;
        EXPECT_EQ(page.ask(message)["ok"], true);
        return audit().size();
    };
    EXPECT_EQ(set("pace", 5, false), 1u);
    EXPECT_EQ(set("start", 1, true), 2u);
    EXPECT_EQ(set("start", 1, false), 2u) << "this is one";
    EXPECT_EQ(set("pace", 6, false), 3u) << "of another variable";
    EXPECT_EQ(set("start", 0, std::nullopt), 4u);
    EXPECT_EQ(set("start", 1, false), 5u) << "it has been let go";
}

TEST_F(ServedSite, WhatListensAtASocketMayAnswerAnything) {
    for (const char* odd : {R"(,"ok":true,"hello":{"machine":5})", R"(,"ok":true,"hello":{"machine":null})",
                            R"(,"ok":false,"error":{"what":5})", R"(,"ok":false,"error":7)"}) {
        machine.stop();
        machine.odd_hello = odd;
        machine.start();
        serve();
        PageClient page;
        ASSERT_TRUE(page.open(port)) << odd;
        EXPECT_FALSE(page.next("hello").is_null()) << odd;
        machine.stop();
        machine.odd_hello.clear();
        machine.start();
        EXPECT_FALSE(page.next([](const PageJson& one) { return one.value("machine", "") == "demo"; }, 5s).is_null()) << odd;
        end();
    }
}

}  // namespace
}  // namespace taktwerk::hmi::web
