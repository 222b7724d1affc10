// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeindex>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

namespace tinsmith::server {

/// What a type is made of: `each(value, visit)` calls `visit` once with references to the parts.
/// One description serves both ways. Those that name all members by a structured binding do not
/// compile once there is another.
template <typename T>
struct Parts;

/// Whether a value's bytes are the value: no pointers, no padding.
template <typename T>
struct IsPlain : std::bool_constant<std::is_arithmetic_v<T> || std::is_enum_v<T> ||
                                    (std::is_class_v<T> && std::is_trivially_copyable_v<T> &&
                                     std::has_unique_object_representations_v<T>)> {};
template <typename T>
concept Plain = IsPlain<T>::value && !std::same_as<T, bool>;

static_assert(std::endian::native == std::endian::little, "what is packed is little-endian");

/// Writes values as bytes: plain ones as they are, lists with their length before them, what is
/// shared once, by the number that it got.
class Packer {
  public:
    template <typename... T>
    void operator()(const T&... values) {
        (put(values), ...);
    }
    std::string take() { return std::move(bytes_); }
    void reserve(std::size_t bytes) { bytes_.reserve(bytes); }

  private:
    template <Plain T>
    void put(const T& value) {
        put_bytes(&value, sizeof value);
    }
    void put(bool value) { bytes_.push_back(value ? '\1' : '\0'); }
    void put(const std::string& text) {
        put(std::uint64_t{text.size()});
        bytes_ += text;
    }
    template <typename T, typename Allocator>
    void put(const std::vector<T, Allocator>& list) {
        put(std::uint64_t{list.size()});
        if constexpr (Plain<T>) {
            put_bytes(list.data(), list.size() * sizeof(T));
        } else {
            for (const T& value : list)
                put(value);
        }
    }
    template <typename A, typename B>
    void put(const std::pair<A, B>& pair) {
        (*this)(pair.first, pair.second);
    }
    template <typename T>
    void put(const std::optional<T>& value) {
        put(value.has_value());
        if (value) put(*value);
    }
    template <typename... T>
    void put(const std::variant<T...>& value) {
        put(static_cast<std::uint8_t>(value.index()));
        std::visit([this](const auto& held) { put(held); }, value);
    }
    /// Owned by one alone.
    template <typename T>
    void put(const std::shared_ptr<T>& owned) {
        put(owned != nullptr);
        if (owned) put(*owned);
    }
    template <typename T>
    void put(const std::shared_ptr<const T>& shared) {
        if (!shared) return put(std::uint32_t{0});
        const auto [place, is_new] =
            numbers_.try_emplace(shared.get(), static_cast<std::uint32_t>(numbers_.size() + 1));
        put(place->second);
        if (is_new) put(*shared);
    }
    template <typename T>
    void put(const T& value) {
        Parts<T>::each(value, [this](const auto&... parts) { (put(parts), ...); });
    }

    void put_bytes(const void* from, std::size_t count) {
        bytes_.append(static_cast<const char*>(from), count);
    }

    std::string bytes_;
    std::unordered_map<const void*, std::uint32_t> numbers_;  ///< of what is shared, from 1 on
};

/// Reads what a Packer wrote, into values of the same types in the same order.
///
/// Laws: nothing is read beyond the bytes, and nothing is made room for that they cannot hold.
/// What makes no sense fails: from then on values stay as they are, and `done` says so.
class Unpacker {
  public:
    explicit Unpacker(std::string_view bytes) : left_(bytes) {}

    template <typename... T>
    void operator()(T&... values) {
        (get(values), ...);
    }
    /// Whether everything made sense and was all there is.
    bool done() const { return !failed_ && left_.empty(); }
    bool failed() const { return failed_; }

  private:
    template <Plain T>
    void get(T& value) {
        get_bytes(&value, sizeof value);
    }
    void get(bool& value) {
        std::uint8_t byte = 0;
        get(byte);
        value = byte == 1;
        failed_ = failed_ || byte > 1;
    }
    void get(std::string& text) {
        const std::size_t count = get_count(1);
        text.assign(left_.data(), count);
        left_.remove_prefix(count);
    }
    template <typename T, typename Allocator>
    void get(std::vector<T, Allocator>& list) {
        list.clear();
        if constexpr (Plain<T>) {
            const std::size_t count = get_count(sizeof(T));
            list.resize(count);
            get_bytes(list.data(), count * sizeof(T));
        } else {
            const std::size_t count = get_count(1);  // each takes a byte at least
            for (std::size_t i = 0; i < count && !failed_; ++i) {
                if (i == list.capacity()) list.reserve(std::min(count, 2 * i + 16));
                get(list.emplace_back());
            }
        }
    }
    template <typename A, typename B>
    void get(std::pair<A, B>& pair) {
        (*this)(pair.first, pair.second);
    }
    template <typename T>
    void get(std::optional<T>& value) {
        bool is_there = false;
        get(is_there);
        value.reset();
        if (is_there && !failed_) get(value.emplace());
    }
    template <typename... T>
    void get(std::variant<T...>& value) {
        std::uint8_t index = 0;
        get(index);
        if (index >= sizeof...(T)) failed_ = true;
        if (!failed_) get_alternative(value, index, std::index_sequence_for<T...>());
    }
    template <typename Variant, std::size_t... I>
    void get_alternative(Variant& value, std::size_t index, std::index_sequence<I...> /*all*/) {
        (static_cast<void>(index == I && (get(value.template emplace<I>()), true)), ...);
    }
    template <typename T>
    void get(std::shared_ptr<T>& owned) {
        bool is_there = false;
        get(is_there);
        owned.reset();
        if (!is_there || failed_) return;
        owned = std::make_shared<T>();
        get(*owned);
    }
    template <typename T>
    void get(std::shared_ptr<const T>& shared) {
        std::uint32_t number = 0;
        get(number);
        shared.reset();
        if (number == 0 || failed_) return;
        if (const auto known = shared_.find(number); known != shared_.end()) {
            if (known->second.first != typeid(T)) failed_ = true;
            if (!failed_) shared = std::static_pointer_cast<const T>(known->second.second);
            return;
        }
        auto made = std::make_shared<T>();
        get(*made);
        shared = std::move(made);
        shared_.try_emplace(number, typeid(T), shared);
    }
    template <typename T>
    void get(T& value) {
        Parts<T>::each(value, [this](auto&... parts) { (get(parts), ...); });
    }

    /// How many things of so many bytes at least come now: as many as the bytes can hold.
    std::size_t get_count(std::size_t least) {
        std::uint64_t count = 0;
        get(count);
        if (count > left_.size() / least) failed_ = true;
        return failed_ ? 0 : static_cast<std::size_t>(count);
    }
    void get_bytes(void* to, std::size_t count) {
        if (count > left_.size()) failed_ = true;
        if (failed_ || count == 0) return;
        std::memcpy(to, left_.data(), count);
        left_.remove_prefix(count);
    }

    std::string_view left_;
    bool failed_ = false;
    std::map<std::uint32_t, std::pair<std::type_index, std::shared_ptr<const void>>> shared_;
};

}  // namespace tinsmith::server
