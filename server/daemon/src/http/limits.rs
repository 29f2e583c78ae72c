//! How much one address may ask: a rate for everything but the stop, and a far lower one for tokens that are not
//! known yet, so that nobody guesses them or has the server hash for them.

use std::net::{IpAddr, SocketAddr};
use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::Duration;

use axum::extract::{ConnectInfo, Request, State};
use axum::http::{HeaderValue, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use governor::clock::{Clock, DefaultClock};
use governor::{DefaultKeyedRateLimiter, Quota, RateLimiter};

use super::STOP_PATH;
use super::problem::Problem;
use crate::app::App;

/// The rates of every address.
#[derive(Debug)]
pub struct Limits {
    requests: DefaultKeyedRateLimiter<IpAddr>,
    unknown_tokens: DefaultKeyedRateLimiter<IpAddr>,
}

/// It asked for too much.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooMuch {
    /// When it may go on.
    pub after: Duration,
}

impl Limits {
    /// With so many requests a second for each address.
    pub fn new(requests_per_sec: usize) -> Self {
        let per_sec =
            u32::try_from(requests_per_sec).ok().and_then(NonZeroU32::new).unwrap_or(NonZeroU32::MIN);
        let burst = per_sec.saturating_mul(BURST);
        Self {
            requests: RateLimiter::keyed(Quota::per_second(per_sec).allow_burst(burst)),
            unknown_tokens: RateLimiter::keyed(Quota::per_minute(TRIES_A_MINUTE)),
        }
    }

    /// Whether this address may show a token that is not known yet.
    pub fn try_token(&self, from: IpAddr) -> Result<(), TooMuch> {
        check(&self.unknown_tokens, from)
    }

    /// Forget the addresses that asked for nothing of late.
    pub fn forget(&self) {
        for rates in [&self.requests, &self.unknown_tokens] {
            rates.retain_recent();
            rates.shrink_to_fit();
        }
    }
}

/// Refuse what is too much. Never the stop.
pub async fn within_rate(State(app): State<Arc<App>>, request: Request, next: Next) -> Response {
    if request.uri().path() != STOP_PATH
        && let Err(too_much) = check(&app.limits.requests, peer(&request))
    {
        return too_much.into_response();
    }
    next.run(request).await
}

/// Where a request comes from.
pub fn peer(request: &Request) -> IpAddr {
    let peer = request.extensions().get::<ConnectInfo<SocketAddr>>().map(|info| info.0.ip());
    address(peer.unwrap_or(IpAddr::from([0, 0, 0, 0])))
}

/// What counts as one address: of IPv6 a whole network, since whoever has one has more addresses than can be counted.
pub fn address(peer: IpAddr) -> IpAddr {
    match peer.to_canonical() {
        IpAddr::V6(ip) => {
            let [a, b, c, d, ..] = ip.segments();
            IpAddr::from([a, b, c, d, 0, 0, 0, 0])
        }
        ip => ip,
    }
}

impl IntoResponse for TooMuch {
    fn into_response(self) -> Response {
        let mut response =
            Problem::too_many("this address asks more often than the server answers").into_response();
        let secs = self.after.as_secs_f64().ceil().max(1.0);
        if let Ok(after) = HeaderValue::from_str(&format!("{secs:.0}")) {
            response.headers_mut().insert(header::RETRY_AFTER, after);
        }
        response
    }
}

fn check(rates: &DefaultKeyedRateLimiter<IpAddr>, from: IpAddr) -> Result<(), TooMuch> {
    rates
        .check_key(&from)
        .map_err(|not_until| TooMuch { after: not_until.wait_time_from(DefaultClock::default().now()) })
}

/// Seconds' worth of requests at once: a page asks for all that it shows when it opens.
const BURST: NonZeroU32 = NonZeroU32::new(5).expect("five is not zero");
const TRIES_A_MINUTE: NonZeroU32 = NonZeroU32::new(10).expect("ten is not zero");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_address_has_a_burst_of_its_own() {
        let limits = Limits::new(2);
        let (one, other) = (IpAddr::from([10, 0, 0, 1]), IpAddr::from([10, 0, 0, 2]));
        let passed = (0..50).take_while(|_| check(&limits.requests, one).is_ok()).count();
        assert!((10..15).contains(&passed), "{passed}");
        assert!(check(&limits.requests, one).unwrap_err().after <= Duration::from_secs(1));
        assert!(check(&limits.requests, other).is_ok());
        let tries = (0..50).take_while(|_| limits.try_token(one).is_ok()).count();
        assert_eq!(tries, 10);
    }
}
