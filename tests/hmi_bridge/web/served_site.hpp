#pragma once
// The page's server in this process, on a thread of its own and any free port, before machines of socket_machine.hpp.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "hmi_bridge/web/account/password.hpp"
#include "hmi_bridge/web/account/users.hpp"
#include "hmi_bridge/web/server/web_server.hpp"
#include "tests/hmi_bridge/web/page_client.hpp"
#include "tests/hmi_bridge/web/socket_machine.hpp"

namespace taktwerk::hmi::web {

class ServedSite : public ::testing::Test {
protected:
    ServedSite() {
        std::filesystem::create_directory(folder_ / "page");
        std::ofstream(folder_ / "page" / "index.html") << "<!doctype html><title>page</title>";
    }
    ~ServedSite() override {
        end();
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }

    /// A user 'anna' (operator), 'olga' (viewer), 'emil' (engineer), 'adam' (admin); each with the password `name` + "-secret".
    std::string users_file() {
        Users users;
        for (const auto& [name, role] : std::vector<std::pair<std::string, Role>>{
                 {"anna", Role::operates}, {"olga", Role::viewer}, {"emil", Role::engineer}, {"adam", Role::admin}})
            EXPECT_TRUE(users.put({name, role, hash_of(name)}));
        const auto path = (folder_ / "users.json").string();
        EXPECT_TRUE(users.save(path));
        return path;
    }
    /// Each costs a tenth of a second and more: made once.
    static const std::string& hash_of(const std::string& name) {
        static std::map<std::string, std::string> made;
        auto& hash = made[name];
        if (hash.empty()) hash = *hash_password(name + "-secret");
        return hash;
    }
    void serve(ServerOptions options = {}) {
        options.port = 0;
        if (options.machines.empty()) options.machines = {machine.path()};
        options.audit = [this](const std::string& line) {
            const std::lock_guard lock(mutex_);
            audit_.push_back(PageJson::parse(line));
        };
        auto opened = WebServer::open(std::move(options), *SiteFiles::load((folder_ / "page").string()));
        ASSERT_TRUE(opened) << opened.error().text();
        server_ = std::move(*opened);
        port = server_->port();
        thread_ = std::thread([this] { server_->run(); });
    }
    void end() {
        if (server_) server_->stop();
        if (thread_.joinable()) thread_.join();
        server_.reset();
    }
    /// Connections and pages in the server's memory.
    [[nodiscard]] std::size_t alive() const { return server_->alive(); }
    [[nodiscard]] std::weak_ptr<const void> memory() const { return server_->memory(); }
    std::vector<PageJson> audit() {
        const std::lock_guard lock(mutex_);
        return audit_;
    }
    [[nodiscard]] std::string own_origin() const { return "Origin: http://127.0.0.1:" + std::to_string(port) + "\r\n"; }
    HttpAnswer log_in(const std::string& user, const std::string& password, const std::string& more = {}) const {
        return http_request(port, "POST /api/login", own_origin() + "Content-Type: application/json\r\n" + more,
                            PageJson{{"user", user}, {"password", password}}.dump(), {}, std::chrono::seconds{30});
    }
    /// The header line of the session that a login opens; empty: none.
    std::string cookie_of(const std::string& user) const {
        const auto cookie = log_in(user, user + "-secret").header("Set-Cookie");
        return cookie.empty() ? std::string{} : "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\n";
    }
    /// Until the page shows this machine.
    static bool shows_machine(PageClient& page) {
        return !page.next([](const PageJson& one) { return one.value("type", "") == "hello" && !one["layout"].is_null(); },
                          std::chrono::seconds{5})
                    .is_null();
    }

    static std::filesystem::path new_folder() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-web-XXXXXX").string();
        return ::mkdtemp(pattern.data());
    }
    const std::filesystem::path folder_ = new_folder();
    SocketMachine machine{"demo", folder_path("demo.sock")};
    std::uint16_t port = 0;

private:
    [[nodiscard]] std::string folder_path(const std::string& name) const { return (folder_ / name).string(); }

    std::unique_ptr<WebServer> server_;
    std::thread thread_;
    std::mutex mutex_;
    std::vector<PageJson> audit_;
};

}  // namespace taktwerk::hmi::web
