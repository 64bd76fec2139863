// JSON objects and lists of them to structures, and what is wrong with one that was not accepted.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "codec/codec.h"
#include "shot/nearest_key.h"

namespace brisance {

// One key of an object.
template <class T>
struct Member {
    std::string name;
    Codec<Json> codec;  // of the value, as far as reading and complaining goes
    std::function<void(T&, const Json&)> set;
    std::function<Json(const T&)> get;
    bool required = false;
};

// `at(object)` returns a reference to the value.
template <class T, class V, class At>
Member<T> member(const std::string& name, const Codec<V>& codec, At at, bool required = false) {
    Codec<Json> untyped{
        codec.schema, codec.expected,
        [codec](const Json& json) { return codec.read(json) ? std::optional<Json>(json) : std::nullopt; },
        [](const Json& json) { return json; }, codec.find_mismatch};
    return {name, untyped, [codec, at](T& object, const Json& json) { at(object) = *codec.read(json); },
            [codec, at](const T& object) {
                T copy = object;  // so that one accessor reads and writes
                return codec.write(at(copy));
            },
            required};
}

template <class T>
std::optional<Mismatch> find_object_mismatch(const std::vector<Member<T>>& members, const std::string& expected,
                                             const Json& json) {
    if (!json.is_object())
        return Mismatch{"", expected, json};
    const auto find = [&](const std::string& name) {
        return std::find_if(members.begin(), members.end(), [&](const Member<T>& m) { return m.name == name; });
    };
    for (const auto& item : json.items()) {
        const auto found = find(item.key());
        if (found == members.end()) {
            std::vector<std::string> names;
            names.reserve(members.size());
            for (const Member<T>& m : members)
                names.push_back(m.name);
            return Mismatch{"", "keys it knows, such as \"" + nearest_key(item.key(), names) + "\"", Json(item.key())};
        }
        if (found->codec.read(item.value()))
            continue;
        Mismatch inner{"", found->codec.expected, item.value()};
        if (found->codec.find_mismatch)
            if (const std::optional<Mismatch> more = found->codec.find_mismatch(item.value()))
                inner = *more;
        inner.path = "." + item.key() + inner.path;
        return inner;
    }
    for (const Member<T>& m : members)
        if (m.required && !json.contains(m.name))
            return Mismatch{"", "\"" + m.name + "\", which is missing: " + m.codec.expected, json};
    return std::nullopt;
}

// Members that are not given keep the values of T{}; those that have them are not written.
template <class T>
Codec<T> object_of(const std::string& what, const std::vector<Member<T>>& members) {
    Codec<T> codec;
    codec.expected = what;
    Json properties = Json::object(), required = Json::array();
    for (const Member<T>& m : members) {
        properties[m.name] = m.codec.schema;
        if (m.required)
            required.push_back(m.name);
    }
    codec.schema = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
    if (!required.empty())
        codec.schema["required"] = required;
    codec.find_mismatch = [members, what](const Json& json) { return find_object_mismatch(members, what, json); };
    codec.read = [members, what](const Json& json) -> std::optional<T> {
        if (find_object_mismatch(members, what, json))
            return std::nullopt;
        T object;
        for (const Member<T>& m : members)
            if (json.contains(m.name))
                m.set(object, json[m.name]);
        return object;
    };
    codec.write = [members](const T& object) {
        const T untouched{};
        Json json = Json::object();
        for (const Member<T>& m : members)
            if (Json value = m.get(object); m.required || value != m.get(untouched))
                json[m.name] = std::move(value);
        return json;
    };
    return codec;
}

template <class T>
Codec<std::vector<T>> list_of(const std::string& what, const Codec<T>& item) {
    Codec<std::vector<T>> codec;
    codec.expected = what;
    codec.schema = {{"type", "array"}, {"items", item.schema}};
    codec.read = [item](const Json& json) -> std::optional<std::vector<T>> {
        if (!json.is_array())
            return std::nullopt;
        std::vector<T> list;
        for (const Json& one : json) {
            std::optional<T> value = item.read(one);
            if (!value)
                return std::nullopt;
            list.push_back(std::move(*value));
        }
        return list;
    };
    codec.write = [item](const std::vector<T>& list) {
        Json json = Json::array();
        for (const T& one : list)
            json.push_back(item.write(one));
        return json;
    };
    codec.find_mismatch = [item](const Json& json) -> std::optional<Mismatch> {
        for (std::size_t i = 0; json.is_array() && i < json.size(); ++i) {
            if (item.read(json[i]))
                continue;
            Mismatch inner{"", item.expected, json[i]};
            if (item.find_mismatch)
                if (const std::optional<Mismatch> more = item.find_mismatch(json[i]))
                    inner = *more;
            inner.path.insert(0, fmt::format("[{}]", i));
            return inner;
        }
        return std::nullopt;
    };
    return codec;
}

}  // namespace brisance
