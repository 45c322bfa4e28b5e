#pragma once
// The machines of this host: found by their sockets, also later. Included by web_server.cpp alone.

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hmi_bridge/socket/socket_path.hpp"
#include "hmi_bridge/web/server/feed.hpp"

namespace taktwerk::hmi::web {

inline Error unknown_machine(const std::string& name) {
    return Error{"web.unknown_machine", name, "there is no such machine on this host", "Choose one of the list."};
}

class Feeds {
public:
    /// `wanted`: names or paths; empty: all. `fresh`: a machine has new values.
    Feeds(asio::io_context& io, std::vector<std::string> wanted, ValueSource source, Feed::Told fresh)
        : io_(io), wanted_(std::move(wanted)), source_(source), fresh_(std::move(fresh)) {}

    void step(Instant at, const std::set<Feed*>& watched) {
        if (at - looked_ >= look_again) {
            looked_ = at;
            look();
        }
        for (const auto& known : by_path_) known.second->step(at, watched.count(known.second.get()) != 0);
    }
    void close() {
        for (const auto& known : by_path_) known.second->close("the server ends");
    }
    [[nodiscard]] std::shared_ptr<Feed> named(const std::string& name) const {
        for (const auto& known : by_path_)
            if (known.second->name() == name) return known.second;
        return nullptr;
    }
    /// The first by name of those that are there, null: none.
    [[nodiscard]] std::shared_ptr<Feed> first() const {
        std::shared_ptr<Feed> best;
        for (const auto& known : by_path_)
            if (known.second->online() && (!best || known.second->name() < best->name())) best = known.second;
        return best;
    }
    /// As a hello tells it.
    [[nodiscard]] Json list() const {
        auto machines = Json::array();
        for (const auto& known : by_path_)
            machines.push_back(Json{{"machine", known.second->name().empty() ? known.first : known.second->name()},
                                    {"online", known.second->online()},
                                    {"why", known.second->online() ? std::string{} : known.second->why()}});
        return machines;
    }
    [[nodiscard]] std::uint64_t version() const { return version_; }  ///< of the list

private:
    static constexpr Duration look_again = 1s;
    static constexpr std::size_t most_machines = 64;

    void look() {
        std::vector<std::string> paths;
        for (const auto& machine : wanted_)
            if (const auto path = find_socket(machine)) paths.push_back(*path);
        if (wanted_.empty())
            for (const auto& folder : socket_folders()) {
                std::error_code failure;
                for (std::filesystem::directory_iterator entry(folder, failure), last; !failure && entry != last; entry.increment(failure))
                    if (entry->path().extension() == ".sock") paths.push_back(entry->path().string());
            }
        for (const auto& path : paths) {
            if (by_path_.count(path) == 0 && by_path_.size() >= most_machines) continue;
            auto& feed = by_path_[path];
            if (!feed)
                feed = std::make_shared<Feed>(
                    io_, path, source_, [this](Feed&) { ++version_; }, fresh_);
            if (!feed->connected()) feed->connect();
        }
    }

    asio::io_context& io_;
    std::vector<std::string> wanted_;
    ValueSource source_;
    Feed::Told fresh_;
    std::map<std::string, std::shared_ptr<Feed>> by_path_;
    std::uint64_t version_ = 0;
    Instant looked_{};
};

}  // namespace taktwerk::hmi::web
