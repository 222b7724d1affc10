// SPDX-License-Identifier: Apache-2.0
// The one file that knows OpenSSL.
#include "server/digest.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <new>

#include <openssl/crypto.h>
#include <openssl/evp.h>

namespace tinsmith::server {

namespace {

class Sha256 {
  public:
    Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
        require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
    }

    void add(const void* bytes, std::size_t size) {
        require(EVP_DigestUpdate(context_.get(), bytes, size) == 1);
    }

    std::string take() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
        unsigned size = 0;
        require(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
        return {digest.begin(), digest.begin() + size};
    }

  private:
    static void require(bool fine) {
        if (!fine) throw std::bad_alloc();
    }

    std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_;
};

}  // namespace

std::string sha256_of(std::span<const std::string_view> parts) {
    Sha256 digest;
    for (const std::string_view part : parts) {
        const auto size = static_cast<std::uint64_t>(part.size());
        digest.add(&size, sizeof size);
        digest.add(part.data(), part.size());
    }
    return digest.take();
}

std::string plain_sha256_of(std::string_view text) {
    Sha256 digest;
    digest.add(text.data(), text.size());
    return digest.take();
}

bool same_in_constant_time(std::string_view one, std::string_view other) {
    return one.size() == other.size() && CRYPTO_memcmp(one.data(), other.data(), one.size()) == 0;
}

}  // namespace tinsmith::server
