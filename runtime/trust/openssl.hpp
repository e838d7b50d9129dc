#pragma once

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>

#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace bodeflow::trust {

template <class T>
using Expected = tl::expected<T, std::string>;

// OpenSSL's objects, freed at the end of their scope.
template <auto free>
struct Freed {
  template <class T>
  void operator()(T* object) const {
    free(object);
  }
};
using Bio = std::unique_ptr<BIO, Freed<BIO_free_all>>;
using Key = std::unique_ptr<EVP_PKEY, Freed<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Freed<X509_free>>;
using RevocationList = std::unique_ptr<X509_CRL, Freed<X509_CRL_free>>;
using Pkcs7 = std::unique_ptr<PKCS7, Freed<PKCS7_free>>;
using Store = std::unique_ptr<X509_STORE, Freed<X509_STORE_free>>;
using StoreContext = std::unique_ptr<X509_STORE_CTX, Freed<X509_STORE_CTX_free>>;

/// `what` and the reason that OpenSSL gives for its last failure; clears its queue of errors.
std::string openssl_failure(const std::string& what);

/// A new buffer in memory.
Bio memory();
/// A buffer that reads `text`, which must outlive it.
Bio reading(const std::string& text);
/// All that was written to a buffer.
std::string text_of(BIO& bio);

}  // namespace bodeflow::trust
