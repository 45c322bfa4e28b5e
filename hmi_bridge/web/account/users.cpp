#include "hmi_bridge/web/account/users.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "hmi_bridge/web/account/password.hpp"
#include "hmi_bridge/web/json_text.hpp"

namespace taktwerk::hmi::web {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t longest_name = 64;
constexpr int deepest = 4;

Error wrong(const std::string& from, std::string what,
            std::string remedy = "Write it with `taktwerk hmi user add NAME ROLE --users FILE`.") {
    return Error{"web.users", from, std::move(what), std::move(remedy)};
}

std::string reason() { return std::strerror(errno); }

/// Closed in any case.
struct OpenFile {
    explicit OpenFile(int number) : fd(number) {}
    ~OpenFile() {
        if (fd >= 0) ::close(fd);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    int fd;
};

Result<User> read_user(const Json& entry, const std::string& where) {
    if (!entry.is_object()) return wrong(where, "this is no object");
    User user;
    for (const auto& member : entry.items()) {
        if (!member.value().is_string()) return wrong(where, fmt::format("'{}' is not a text", member.key()));
        const auto value = member.value().get<std::string>();
        if (member.key() == "name") user.name = value;
        else if (member.key() == "password") user.password = value;
        else if (member.key() == "role") {
            const auto role = role_of(value);
            if (!role) return wrong(where, "the role is none of viewer, operator, engineer, admin");
            user.role = *role;
        } else return wrong(where, fmt::format("the key '{}' is unknown", member.key()));
    }
    if (!entry.contains("role")) return wrong(where, "the role is missing");
    return user;
}

}  // namespace

bool is_user_name(std::string_view name) {
    if (name.empty() || name.size() > longest_name) return false;
    if (std::any_of(name.begin(), name.end(),
                    [](char c) { return (static_cast<unsigned char>(c) <= ' ') || c == 0x7f || c == '"' || c == '\\'; }))
        return false;
    return is_utf8(name);
}

Result<Users> Users::read(std::string_view text, const std::string& from) {
    if (text.size() > longest_file) return wrong(from, "the file is longer than 256 KiB");
    const auto json = read_json(text, deepest);
    if (!json) return wrong(from, json.error().what);
    if (!json->is_object() || json->size() != 1 || !json->contains("users") || !(*json)["users"].is_array())
        return wrong(from, "it is no object with the one key 'users', a list");
    Users out;
    for (const auto& entry : (*json)["users"]) {
        const auto where = fmt::format("{}, user {}", from, out.users_.size() + 1);
        auto user = read_user(entry, where);
        if (!user) return std::move(user).error();
        if (out.find(user->name) != nullptr) return wrong(where, fmt::format("'{}' stands there twice", user->name));
        if (auto put = out.put(std::move(*user)); !put) return wrong(where, put.error().what);
    }
    return out;
}

Result<Users> Users::load(const std::string& path) {
    const OpenFile file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (file.fd < 0) return wrong(path, "the file of the users cannot be read: " + reason());
    struct stat state {};
    if (::fstat(file.fd, &state) != 0 || !S_ISREG(state.st_mode)) return wrong(path, "this is no file");
    if ((state.st_mode & 0027) != 0)
        return wrong(path, fmt::format("mode {:04o} lets others read or change who may do what", state.st_mode & 07777), "chmod 0640 it.");
    if (state.st_uid != 0 && state.st_uid != ::geteuid())
        return wrong(path, fmt::format("it belongs to user {}", state.st_uid), "It has to be this server's user's or root's.");
    std::string text;
    std::array<char, 4096> part;
    for (ssize_t got = 0; text.size() <= longest_file && (got = ::read(file.fd, part.data(), part.size())) > 0;)
        text.append(part.data(), static_cast<std::size_t>(got));
    return read(text, path);
}

std::string Users::text() const {
    auto list = Json::array();
    for (const auto& user : users_) list.push_back(Json{{"name", user.name}, {"role", word(user.role)}, {"password", user.password}});
    return Json{{"users", std::move(list)}}.dump(2) + "\n";
}

Result<void> Users::save(const std::string& path) const {
    mode_t mode = 0640;
    struct stat before {};
    const bool there = ::stat(path.c_str(), &before) == 0;
    if (there) mode = before.st_mode & 0640;
    const auto beside = fmt::format("{}.{}", path, ::getpid());
    const auto all = text();
    {
        const OpenFile file{::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600)};
        if (file.fd < 0) return wrong(path, "it cannot be written: " + reason(), "Name a file in a folder that this user may write to.");
        const bool written = ::write(file.fd, all.data(), all.size()) == static_cast<ssize_t>(all.size()) && ::fchmod(file.fd, mode) == 0 &&
                             (!there || ::fchown(file.fd, before.st_uid, before.st_gid) == 0 || ::geteuid() != 0) && ::fsync(file.fd) == 0;
        if (!written) {
            const auto why = reason();
            ::unlink(beside.c_str());
            return wrong(path, "it cannot be written: " + why, "Look at the disk.");
        }
    }
    if (::rename(beside.c_str(), path.c_str()) != 0) {
        const auto why = reason();
        ::unlink(beside.c_str());
        return wrong(path, "it cannot be replaced: " + why, "Look at who may write to its folder.");
    }
    return {};
}

const User* Users::find(std::string_view name) const {
    const auto found = std::find_if(users_.begin(), users_.end(), [&](const User& user) { return user.name == name; });
    return found == users_.end() ? nullptr : &*found;
}

Result<void> Users::put(User user) {
    if (!is_user_name(user.name))
        return wrong("user", "a name has 1 to 64 bytes of UTF-8 without spaces, quotes and control characters", "Choose another name.");
    if (!is_password_hash(user.password)) return wrong("user " + user.name, "the password is no Argon2id hash of this program's cost");
    remove(user.name);
    if (users_.size() >= most) return wrong("user " + user.name, fmt::format("there are {} users already", most), "Remove one first.");
    users_.insert(std::upper_bound(users_.begin(), users_.end(), user, [](const User& a, const User& b) { return a.name < b.name; }),
                  std::move(user));
    return {};
}

bool Users::remove(std::string_view name) {
    return std::erase_if(users_, [&](const User& user) { return user.name == name; }) > 0;
}

}  // namespace taktwerk::hmi::web
