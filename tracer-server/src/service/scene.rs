//! Sending the scene.

use std::sync::Arc;
use std::time::Duration;

use proto::v1::SceneChunk;
use tokio::sync::mpsc;
use tonic::Status;

use super::SessionInfo;

/// How long a viewer may take over one chunk.
const CHUNK_TIMEOUT: Duration = Duration::from_secs(30);

/// Sends the scene chunk by chunk, each made when there is room for it.
pub(super) async fn send(info: Arc<SessionInfo>, chunks: mpsc::Sender<Result<SceneChunk, Status>>) {
    let SessionInfo { welcome, mesh } = &*info;
    for chunk in proto::scene_chunks(&welcome.scene_hash, welcome.frame, mesh) {
        let sent = tokio::time::timeout(CHUNK_TIMEOUT, chunks.send(Ok(chunk))).await;
        if !matches!(sent, Ok(Ok(()))) {
            tracing::debug!("a viewer left before it had the whole scene");
            return;
        }
    }
}
