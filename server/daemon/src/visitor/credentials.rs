//! What the visitor shows a server, and whom it trusts: its token, and the authority that signed the server's certificate.

use std::path::Path;
use std::sync::Arc;

use anyhow::Context;
use rustls::pki_types::CertificateDer;
use rustls::pki_types::pem::PemObject;
use rustls::{ClientConfig, RootCertStore};
use tokio::net::TcpStream;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::http::header::AUTHORIZATION;
use tokio_tungstenite::tungstenite::http::{HeaderValue, Request};
use tokio_tungstenite::{Connector, MaybeTlsStream, WebSocketStream, connect_async_tls_with_config};

/// A token, an authority, both or none.
#[derive(Debug, Clone)]
pub struct Credentials {
    bearer: Option<HeaderValue>,
    tls: Option<Arc<ClientConfig>>,
}

/// A connected socket.
pub type Socket = WebSocketStream<MaybeTlsStream<TcpStream>>;

impl Credentials {
    /// Of a token and the file of an authority's certificates (PEM).
    pub fn new(token: Option<&str>, authority: Option<&Path>) -> anyhow::Result<Self> {
        let bearer = token.map(|token| format!("Bearer {token}").parse()).transpose().context("--token")?;
        Ok(Self { bearer, tls: authority.map(trusting).transpose()? })
    }

    /// An HTTP client that shows and trusts them.
    pub fn http(&self) -> reqwest::ClientBuilder {
        let mut builder = reqwest::Client::builder();
        if let Some(tls) = &self.tls {
            builder = builder.use_preconfigured_tls(ClientConfig::clone(tls));
        }
        let bearer = self.bearer.iter().map(|bearer| (AUTHORIZATION, bearer.clone()));
        builder.default_headers(bearer.collect())
    }

    /// A request for a socket that shows them.
    pub fn request(&self, url: &str) -> anyhow::Result<Request<()>> {
        let mut request = url.into_client_request()?;
        if let Some(bearer) = &self.bearer {
            request.headers_mut().insert(AUTHORIZATION, bearer.clone());
        }
        Ok(request)
    }

    /// Open a socket. Without Nagle's delay: a pose that waits for the one before is old.
    pub async fn connect(
        &self,
        request: Request<()>,
    ) -> Result<Socket, tokio_tungstenite::tungstenite::Error> {
        let connector = self.tls.clone().map(Connector::Rustls);
        Ok(connect_async_tls_with_config(request, None, true, connector).await?.0)
    }
}

fn trusting(authority: &Path) -> anyhow::Result<Arc<ClientConfig>> {
    let name = || format!("--authority {}", authority.display());
    let mut roots = RootCertStore::empty();
    for certificate in CertificateDer::pem_file_iter(authority).with_context(name)? {
        roots.add(certificate.with_context(name)?).with_context(name)?;
    }
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let config = ClientConfig::builder_with_provider(provider).with_safe_default_protocol_versions()?;
    Ok(Arc::new(config.with_root_certificates(roots).with_no_client_auth()))
}
