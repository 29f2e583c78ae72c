//! A bare tokio-tungstenite echo server: what the same frames cost with nobody thinking about them.

use std::net::SocketAddr;

use futures_util::{SinkExt, StreamExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::task::JoinHandle;
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream, accept_async, connect_async_with_config};

/// A client's socket.
pub type Socket = WebSocketStream<MaybeTlsStream<TcpStream>>;

/// The running echo server.
pub struct Echo {
    address: SocketAddr,
    task: JoinHandle<()>,
}

impl Echo {
    /// Start, without Nagle's delay, as the real server does.
    pub async fn start() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let address = listener.local_addr().unwrap();
        let task = tokio::spawn(async move {
            while let Ok((connection, _)) = listener.accept().await {
                connection.set_nodelay(true).unwrap();
                tokio::spawn(async move {
                    let mut socket = accept_async(connection).await.unwrap();
                    while let Some(Ok(message)) = socket.next().await {
                        if message.is_close() || socket.send(message).await.is_err() {
                            return;
                        }
                    }
                });
            }
        });
        Self { address, task }
    }

    /// A connected client.
    pub async fn connect(&self) -> Socket {
        connect_async_with_config(format!("ws://{}", self.address), None, true).await.unwrap().0
    }
}

impl Drop for Echo {
    fn drop(&mut self) {
        self.task.abort();
    }
}
