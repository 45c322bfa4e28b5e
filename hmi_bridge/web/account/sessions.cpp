#include "hmi_bridge/web/account/sessions.hpp"

#include <utility>

#include "hmi_bridge/web/account/password.hpp"

namespace taktwerk::hmi::web {

std::string Sessions::open(const User& user, Instant now) {
    std::size_t count = 0;
    if (const auto oldest = stalest(user.name, count); count >= most_of_user) end(oldest);
    if (const auto oldest = stalest({}, count); count >= most) end(oldest);
    auto token = random_token();
    by_digest_[token_digest(token)] = std::make_shared<Session>(Session{user.name, user.role, user.password, now, now, false});
    return token;
}

std::shared_ptr<Session> Sessions::find(std::string_view token, Instant now) {
    if (token.empty()) return nullptr;
    expire(now);
    const auto found = by_digest_.find(token_digest(token));
    if (found == by_digest_.end()) return nullptr;
    found->second->used = now;
    return found->second;
}

void Sessions::close(std::string_view token) {
    if (const auto found = by_digest_.find(token_digest(token)); found != by_digest_.end()) end(found);
}

void Sessions::expire(Instant now) {
    for (auto one = by_digest_.begin(); one != by_digest_.end();) {
        const bool old = now - one->second->used > idle || now - one->second->opened > longest;
        one = old ? end(one) : std::next(one);
    }
}

void Sessions::apply(const Users& users) {
    for (auto one = by_digest_.begin(); one != by_digest_.end();) {
        const auto* user = users.find(one->second->user);
        if (user == nullptr || user->password != one->second->password) {
            one = end(one);
            continue;
        }
        one->second->role = user->role;
        ++one;
    }
}

Sessions::ByDigest::iterator Sessions::end(ByDigest::iterator session) {
    session->second->ended = true;
    return by_digest_.erase(session);
}

Sessions::ByDigest::iterator Sessions::stalest(std::string_view user, std::size_t& count) {
    auto found = by_digest_.end();
    count = 0;
    for (auto one = by_digest_.begin(); one != by_digest_.end(); ++one) {
        if (!user.empty() && one->second->user != user) continue;
        ++count;
        if (found == by_digest_.end() || one->second->used < found->second->used) found = one;
    }
    return found;
}

std::string_view cookie_value(std::string_view header, std::string_view name) {
    while (!header.empty()) {
        const auto end = header.find(';');
        auto pair = header.substr(0, end);
        header = end == std::string_view::npos ? std::string_view{} : header.substr(end + 1);
        while (!pair.empty() && pair.front() == ' ') pair.remove_prefix(1);
        if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=') return pair.substr(name.size() + 1);
    }
    return {};
}

}  // namespace taktwerk::hmi::web
