//! The listening socket: plain or TLS, with a limit on how long a connection may take to say what it wants. A thousand
//! connections that say nothing are gone after that; none of them takes a stop's place.

use std::net::SocketAddr;
use std::time::Duration;

use anyhow::{Context, ensure};
use axum::Router;
use axum_server::Handle;
use axum_server::accept::NoDelayAcceptor;
use axum_server::tls_rustls::{RustlsAcceptor, RustlsConfig};
use nix::sys::resource::{Resource, getrlimit, setrlimit};
use tokio::net::TcpListener;
use tokio::task::JoinHandle;

use crate::access::Roster;
use crate::config::{Config, MachineKind};

/// The server, listening.
#[derive(Debug)]
pub struct Listening {
    /// Ends when the sockets are closed.
    pub http: JoinHandle<std::io::Result<()>>,
    handle: Handle<SocketAddr>,
}

/// Refuse another address than this machine's own without TLS, before anything is touched.
pub fn check_reach(config: &Config) -> anyhow::Result<()> {
    let server = &config.server;
    let (certificate, key) = (&server.tls_certificate, &server.tls_key);
    ensure!(
        certificate.is_some() == key.is_some(),
        "server.tls_certificate and server.tls_key belong together: found one of them alone"
    );
    if server.bind.ip().is_loopback() {
        return Ok(());
    }
    if server.insecure_lan {
        ensure!(
            config.machine.kind == MachineKind::Simulated,
            "server.insecure_lan is for the simulated machine alone, not for \"{}\"",
            config.machine.kind.name()
        );
        return Ok(());
    }
    let bind = server.bind;
    ensure!(
        certificate.is_some(),
        "server.bind: {bind} is reachable from the network, which needs TLS (covr cert, then server.tls_certificate and \
         server.tls_key) and tokens (covr token create); use 127.0.0.1, or say server.insecure_lan = true or \
         --insecure-lan (simulated machine only)"
    );
    ensure!(server.database.exists(), NO_TOKEN);
    Ok(())
}

/// Refuse it without a token, too.
pub fn check_tokens(config: &Config, roster: &Roster) -> anyhow::Result<()> {
    let needs_none = config.server.bind.ip().is_loopback() || config.server.insecure_lan;
    ensure!(needs_none || roster.has_token_in_force(), NO_TOKEN);
    Ok(())
}

/// The certificate and its key, read; none: no TLS.
pub async fn tls(config: &Config) -> anyhow::Result<Option<RustlsConfig>> {
    let (Some(certificate), Some(key)) = (&config.server.tls_certificate, &config.server.tls_key) else {
        return Ok(None);
    };
    // Another part of the process may have chosen it already.
    let _ = rustls::crypto::ring::default_provider().install_default();
    let tls = RustlsConfig::from_pem_file(certificate, key).await.with_context(|| {
        format!("server.tls_certificate {}, server.tls_key {}", certificate.display(), key.display())
    })?;
    Ok(Some(tls))
}

/// Answer on this socket.
pub fn listen(
    listener: TcpListener,
    config: &Config,
    tls: Option<RustlsConfig>,
    router: Router,
) -> Listening {
    allow_many_connections();
    let handle = Handle::new();
    let longest = Duration::from_secs_f64(config.server.header_timeout_secs);
    let mut server = axum_server::Server::<SocketAddr>::from_listener(listener)
        .handle(handle.clone())
        .first_request_timeout(longest);
    server.http_builder().http1().header_read_timeout(longest);
    server.http_builder().http2().max_concurrent_streams(MOST_STREAMS).keep_alive_interval(longest);
    let service = router.into_make_service_with_connect_info::<SocketAddr>();
    // Without Nagle's delay: a column's position that waits for the one before is old.
    let http = match tls {
        Some(tls) => {
            let acceptor = RustlsAcceptor::new(tls).handshake_timeout(longest).acceptor(NoDelayAcceptor);
            tokio::spawn(server.acceptor(acceptor).serve(service))
        }
        None => tokio::spawn(server.acceptor(NoDelayAcceptor).serve(service)),
    };
    Listening { http, handle }
}

impl Listening {
    /// Take no new connection, and give those that are open this long.
    pub fn close(&self, longest: Duration) {
        self.handle.graceful_shutdown(Some(longest));
    }
}

/// As many files as the system lets: each connection is one, and a stop needs one too.
fn allow_many_connections() {
    let raised = getrlimit(Resource::RLIMIT_NOFILE)
        .and_then(|(_, most)| setrlimit(Resource::RLIMIT_NOFILE, most, most).map(|()| most));
    match raised {
        Ok(most) => tracing::debug!(most, "open files"),
        Err(why) => tracing::warn!(%why, "the limit of open files stays as it was"),
    }
}

const NO_TOKEN: &str = "there is no token in force, and the network may not reach a server that asks nobody who they are: \
    make one with covr token create NAME --role administrator";
const MOST_STREAMS: u32 = 64;
